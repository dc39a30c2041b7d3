// Height maps below a surface. Scenes hold them in the alpha of normal maps.
#pragma once
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/scene/scene.h"
#include "core/scene/surface_maps.h"

namespace burnish {

// Returns true where two textures have equal coordinates, transform and sampler.
bool lie_alike(const Scene& scene, const TextureRef& a, const TextureRef& b);

// Returns the height in [0,1] from an image's red channel: bilinear or nearest, as the sampler asks. u, v: texture
// coordinates.
float height_at(const Image& heights, const Texture& sampler, double u, double v);

// Converts an image of depths to heights: 16 bits, red only. Repaired texels lie at the surface.
SurfaceMap heights_of_depths(const Image& depths);

// Moves each height_tex into the alpha of its material's normal map, in 16 bits and the larger of both sizes. Makes a
// flat normal map where there is none. Warns of height maps whose coordinates differ from the normal map's, and ignores
// them. Texels that are not numbers lie at the surface. Errors: more bytes than the texture limit. `file` names the
// scene in errors.
Status pack_height_maps(Scene& scene, const Limits& limits, const std::string& file);

} // namespace burnish
