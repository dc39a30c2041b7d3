// Levels of base colours and metalness that are no plain means: weighted by how much of each texel is seen and lit, or sharper.
#pragma once
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "shading/bake/mip/colour_levels.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mip/source.h"
#include "shading/bake/mip/texture.h"

namespace burnish {

// A map's channels from `first` on as linear floats, times a factor each, at the points of a grid.
Image linear_map(const Image& image, const Grid& grid, bool srgb, std::size_t first, int channels, const float* factor);

// (n.v)(n.l) of a texel that is seen and lit from above its surface, one channel.
Image facing_of(const MipSource& source);

// Whether colours of a texture of the material are weighted by its normals: it wants that, and they lie alike.
bool is_coupled(const Scene& scene, const Material& material, const TextureRef& colours);
// Where base colours are not, though the material wants it, why; else empty.
std::string why_uncoupled(const Scene& scene, const Material& material);

// kaiser: as ColourKernel has it. coupled: the material's normals weigh.
TexturePyramid colour_pyramid(const Scene& scene, const Material& material, const Texture& texture, TextureEncoding encoding, bool coupled,
                              bool kaiser);

} // namespace burnish
