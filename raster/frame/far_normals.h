// Normal maps from afar: the light share that their facets keep, and groups of these facets.
#pragma once
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/kept_light.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/records.h"

namespace burnish {

float mean_roughness(const Scene& scene, const Material& material); // estimated from up to 1024 texels of the roughness map

// Returns the share of light that each facet of the normal map keeps. Returns none where alpha holds heights, or where gains are measured.
KeptWeights kept_weights_of(const Scene& scene, const Material& material, const MaterialMips& mips);
// Returns these shares for every material, in order.
std::vector<KeptWeights> kept_weights_by_material(const Scene& scene, const SceneMips& mips, const Jobs& jobs);

// Makes the normal map's pyramid, with the facets' light share in its levels' alpha.
TexturePyramid kept_pyramid(const Scene& scene, const Material& material, const Texture& sampler, TextureEncoding encoding);

// Fills a record's fields for both. kept: of the material.
void put_far_normals(const Scene& scene, const Material& material, const MaterialMips& mips, const KeptWeights& kept, MaterialRecord& to);

// Returns the reason why the normal map's levels cannot keep the facets' light though facets lose much of it. Empty if there is none.
std::string why_dim(const Scene& scene, const Material& material);

} // namespace burnish
