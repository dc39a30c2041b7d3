// Maps of heights below a surface, as scenes hold them: in the alpha of normal maps.
#pragma once
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/scene/scene.h"
#include "core/scene/surface_maps.h"

namespace burnish {

// Whether two textures have the same coordinates, transform and sampler.
bool lie_alike(const Scene& scene, const TextureRef& a, const TextureRef& b);

// Height of a picture's red at texel centres between its own, [0,1]: bilinear or nearest, as the sampler has it. u, v: texture coordinates.
float height_at(const Image& heights, const Texture& sampler, double u, double v);

// A picture of depths as heights, 16 bits, red alone. Repaired: at the surface.
SurfaceMap heights_of_depths(const Image& depths);

// Puts every height_tex into the alpha of its material's normal map, of 16 bits and as wide and high as the larger of both; where there is
// no normal map, one that is level. Maps that lie otherwise than the normal map are not looked at, with a warning; neither are numbers that
// are none (the surface). Errors: more bytes than textures may have. file: for errors.
Status lay_heights(Scene& scene, const Limits& limits, const std::string& file);

} // namespace burnish
