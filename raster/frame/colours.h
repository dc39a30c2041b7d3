// Levels of base colours and metalness that are no plain means: weighted by how much of each texel is seen and lit, or sharper.
#pragma once
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/colour_levels.h"
#include "shading/bake/mip/grid.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mip/source.h"

namespace burnish {

// A map's channels from `first` on as linear floats, times a factor each, at the points of a grid.
Image linear_map(const Image& image, const Grid& grid, bool srgb, std::size_t first, int channels, const float* factor);

// (n.v)(n.l) of a texel that is seen and lit from above its surface, one channel.
Image facing_of(const MipSource& source, const Jobs& jobs);

// Whether colours of a texture of the material are weighted by its normals: it wants that, and they lie alike.
bool is_coupled(const Scene& scene, const Material& material, const MaterialMips& mips, const TextureRef& colours);
// Where base colours are not, though the material wants it, why; else empty.
std::string why_uncoupled(const Scene& scene, const Material& material, const MaterialMips& mips);

// Maps of a material whose levels are means, and by what they are made.
struct UsedMap {
    MapPart part;
    const TextureRef* ref;
    ColourKernel kernel;
    bool coupled;
};
std::vector<UsedMap> used_maps(const Scene& scene, const Material& material, const MaterialMips& mips);
const char* name_of(MapPart part); // to be read

MapId map_id(const Scene& scene, const Material& material, const UsedMap& map, const Jobs& jobs);
MapLevels map_levels(const Scene& scene, const Material& material, const UsedMap& map, const MapId& id, const Jobs& jobs); // id: map_id()
MipSource normals_of(const Scene& scene, const Material& material); // of its normal map alone, on the grid of that
const Image& map_image(const Scene& scene, const TextureRef& used);
// Those of the image that are so made, and have its sides; null where there are none.
const MapLevels* find_map(const std::vector<MapLevels>& maps, const MapId& id, const Image& image);
// Those that were baked beforehand or found in the cache: null where there are none, so that they are made here.
const MapLevels* given_map(const Scene& scene, const SceneMips& mips, const Material& material, const UsedMap& map);

} // namespace burnish
