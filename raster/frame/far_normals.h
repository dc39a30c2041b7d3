// Normal maps from afar: the light share that their facets keep, and groups of these facets.
#pragma once
#include <string>

#include "core/scene/scene.h"
#include "shading/bake/mip/kept_light.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/records.h"

namespace burnish {

float mean_roughness(const Scene& scene, const Material& material); // estimated from up to 1024 texels of the roughness map

// Returns the shares of light that the normal map's facets keep. Empty if the map's alpha holds heights, if the material is anisotropic or
// unlit, or if the levels have measured gains.
KeptWeights kept_weights_of(const Scene& scene, const Material& material);

// Makes the normal map's pyramid, with the facets' light share in its levels' alpha.
TexturePyramid kept_pyramid(const Scene& scene, const Material& material, const Texture& sampler, TextureEncoding encoding);

// Fills the record's facet groups and kept shares.
void put_far_normals(const Scene& scene, const Material& material, MaterialRecord& to);

// Returns the reason why the normal map's levels cannot keep the facets' light though facets lose much of it. Empty if there is none.
std::string why_dim(const Scene& scene, const Material& material);

} // namespace burnish
