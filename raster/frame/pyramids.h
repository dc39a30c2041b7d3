// Texture pyramids of a scene's materials. A material's texture slot holds the image itself, anisotropy tensors made from a texture, or
// slope moments in place of these tensors. There are three kinds of moments:
//   All lobes: a tilt map lies over an anisotropy map, and roughness is constant. The moments include the texels' lobes.
//   Tilts: any other material with a tilt map, and frames that override roughness or anisotropy. The moments come beside the
//     material's lobe. A `lean` material has such moments for its normals.
//   Filtered levels: a mip filter has made levels of normals and lobes together (shading/bake/mip/filter.h). The means are x and y of the
//     normals. The moments include the normals' difference between taps, times gain_of_taps(). The normal map's slot holds the levels'
//     normals as halves, for readers that need nothing else. Frames that override roughness or anisotropy, or use no normal maps, have
//     moments from the normals alone here, as `lean` has.
// A normal map without heights stores a light share in its levels' alpha if its facets lose light: the share that facets keep above the
// surface's horizon (shading/bake/mip/kept_light.h).
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/optimised_mip.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/tables.h"

namespace burnish {

std::string levels_name(const Scene& scene, const Material& m, const MaterialMips& mips); // "material 'steel' by kappa"

class MipSource;
struct KeptWeights;
struct MipHelp;

struct PyramidKey {
    std::int32_t texture; // its sampler, and without moments its image
    TextureEncoding encoding;
    int tensor_power;              // 2, 4: tensors from an anisotropy texture, or half the moments; 0: the image itself
    int moments = kNoMoments;      // kMomentsOfTilt...
    std::int32_t material = kNone; // owner of the moments: the first material that shares them
    bool filtered = false;         // made from a mip filter's levels for that material
    bool coupled = false;          // colours: weighted by that material's normals
    bool kaiser = false;           // colours: filtered with ColourKernel::kaiser
    bool keeps = false;            // normals: alpha of the levels is the light share that facets keep, for that material
    bool coat = false;             // a coat's normals: alpha of the levels is their spread (coat_normals.h), for that material
    bool operator==(const PyramidKey&) const = default;
};

// Takes kept_weights_by_material(), as the functions below do.
std::vector<PyramidKey> used_pyramids(const Scene& scene, const SceneMips& mips, const std::vector<KeptWeights>& kept); // each once

// Textures, by their places in `keys`, and moments of a material. overridden: in frames that override roughness or anisotropy.
void bind_textures(const Scene& scene, const SceneMips& mips, const std::vector<KeptWeights>& kept, std::size_t material, bool overridden,
                   const std::vector<PyramidKey>& keys, MaterialRecord& to);

// Levels by material, null if no filter makes any. They come from the scene, or are made here. Materials share equal levels.
using MaterialLevels = std::vector<std::shared_ptr<const MipLevels>>;
// wanted: by material, whether its own levels are made; null: all.
MaterialLevels filtered_levels(const Scene& scene, const SceneMips& mips, const Jobs& jobs, const OptimisedTexels& advance = {},
                               const std::vector<bool>* wanted = nullptr);
// Returns the materials that filtered_levels() makes levels for, by index. Other materials have none, or the levels of one of these.
std::vector<std::size_t> filtered_materials(const Scene& scene, const SceneMips& mips);
bool is_metal(const Scene& scene, const Material& material); // more than half of it

// Returns the reason why the material's filter makes no levels. Returns an empty text where levels are made or not needed.
std::string why_unfiltered(const Scene& scene, const Material& material, const MaterialMips& mips);
// Returns true if the material's levels have gains. Materials that let light through have none.
bool has_gains(const Material& material, const MaterialMips& mips);
// The maps of a material from which a filter makes levels.
bool is_filtered(const Scene& scene, const Material& material, const MaterialMips& mips);
MipHelp mip_help(const Scene& scene, const Material& material, const MaterialMips& mips, const OptimisedTexels& advance = {});
MipSource mip_source(const Scene& scene, const Material& material);
// Returns the source's hash. Keeps the hash in the material's settings, since hashing decodes all texels.
std::uint64_t source_hash(const MipSource& source, MaterialMips& mips, const Jobs& jobs);
// Returns true if levels baked beforehand belong to these maps and filters.
bool fits(const MipLevels& levels, const MipSource& source, std::uint64_t hash, const Scene& scene, const Material& material,
          const MaterialMips& mips);

// Pyramids that renderers of one scene hand on. A key's pyramid depends on its material's fields, if it has one, and on the scene's images.
struct PyramidCache {
    std::vector<std::pair<PyramidKey, std::shared_ptr<const TexturePyramid>>> all;
    void forget_material(std::int32_t material); // call after a change to its fields
};
// Returns the pyramids of the keys. Makes those that are not cached, in parallel, and caches exactly these.
std::vector<std::shared_ptr<const TexturePyramid>> make_pyramids(const Scene& scene, const SceneMips& mips,
                                                                 const std::vector<KeptWeights>& kept, const std::vector<PyramidKey>& keys,
                                                                 const Jobs& jobs, PyramidCache* cache);

} // namespace burnish
