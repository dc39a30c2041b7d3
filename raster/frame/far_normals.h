// What a material's normal map is from afar: the share of light that its facets keep, and groups of these facets.
#pragma once
#include <string>

#include "core/scene/scene.h"
#include "shading/bake/mip/kept_light.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/records.h"

namespace burnish {

float mean_roughness(const Scene& scene, const Material& material); // from some texels of its map

// What the facets of its normal map keep of their light. None where heights lie in its alpha, and where gains have been measured in its
// place.
KeptWeights kept_weights_of(const Scene& scene, const Material& material, const MaterialMips& mips);

// The normal map as it is, but with the share that facets keep in the alpha of its levels.
TexturePyramid kept_pyramid(const Scene& scene, const Material& material, const Texture& sampler, TextureEncoding encoding);

// Fills what materials hold of both.
void put_far_normals(const Scene& scene, const Material& material, const MaterialMips& mips, MaterialRecord& to);

// Why levels of its normal map cannot keep the light of its facets, which lose much of it: empty where they keep it.
std::string why_dim(const Scene& scene, const Material& material);

} // namespace burnish
