// Mip levels of base colours and metalness that are not plain means: weighted by each texel's visibility and lighting, or sharpened.
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

// Resamples map channels from `first` on to the points of a grid, as linear floats. Multiplies each channel by its factor.
Image linear_map(const Image& image, const Grid& grid, bool srgb, std::size_t first, int channels, const float* factor);

// Returns (n.v)(n.l) per texel, seen and lit from above the surface. One channel.
Image facing_of(const MipSource& source, const Jobs& jobs);

// Returns true if normals weigh the colours of a material's texture: the material wants weights, and both maps lie alike.
bool is_coupled(const Scene& scene, const Material& material, const MaterialMips& mips, const TextureRef& colours);
// Where base colours are not, though the material wants it, why; else empty.
std::string why_uncoupled(const Scene& scene, const Material& material, const MaterialMips& mips);

// A material map whose levels are means, and the way these levels are made.
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
MipSource normals_of(const Scene& scene, const Material& material); // from the normal map alone, on that map's grid
const Image& map_image(const Scene& scene, const TextureRef& used);
// Finds the levels with this id that fit the image's sides. Null if there are none.
const MapLevels* find_map(const std::vector<MapLevels>& maps, const MapId& id, const Image& image);
// Returns the levels that were baked beforehand or found in the cache. Null if there are none: the caller makes them.
const MapLevels* given_map(const Scene& scene, const SceneMips& mips, const Material& material, const UsedMap& map);

} // namespace burnish
