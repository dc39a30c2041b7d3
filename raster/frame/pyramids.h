// Which texture pyramids the materials of a scene need, and what they are made of. A slot of a material holds an image as it is, tensors of
// an anisotropy texture, or, in their place, moments of slopes:
//   of all, where a map of tilts lies over one of anisotropy and roughness is the same everywhere: the texels' lobes are in them
//   of tilts, where there is a map of them else: beside the lobe of the material, and in frames that override roughness or anisotropy;
//     or of normals, in a material that is `lean`
//   of all, of levels that a mip filter has made of normals and lobes (shading/bake/mip/filter.h): their means are x and y of normals,
//     and what these differ by between taps, times gain_of_taps(), is in the moments; in the normal map's place lie the levels' normals,
//     in one half, for those who read nothing else. Frames that override roughness or anisotropy, or want no normal maps, have moments of
//     the normals alone there, as `lean` has them
// A normal map without heights holds in the alpha of its levels the share of light that facets keep above the surface's horizon
// (shading/bake/mip/kept_light.h), where they lose any.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mip/teacher.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/tables.h"

namespace burnish {

std::string levels_name(const Material& m, const MaterialMips& mips); // "material 'steel' by kappa"

class MipSource;
struct MipHelp;

struct PyramidKey {
    std::int32_t texture; // its sampler, and without moments its image
    TextureEncoding encoding;
    int tensor_power;              // 2, 4: tensors of an anisotropy texture, or a part of moments; 0: the image itself
    int moments = kNoMoments;      // kMomentsOfTilt...
    std::int32_t material = kNone; // whose moments: the first of those that have them in common
    bool filtered = false;         // made of a mip filter's levels of that material
    bool coupled = false;          // of colours: weighted by that material's normals
    bool kaiser = false;           // of colours: by ColourKernel::kaiser
    bool keeps = false;            // of normals: alpha of levels is the share of light that facets keep, by that material
    bool operator==(const PyramidKey&) const = default;
};

std::vector<PyramidKey> used_pyramids(const Scene& scene, const SceneMips& mips); // each once

// Textures, by their places in `keys`, and moments of a material. overridden: in frames that override roughness or anisotropy.
void bind_textures(const Scene& scene, const SceneMips& mips, std::size_t material, bool overridden, const std::vector<PyramidKey>& keys,
                   MaterialRecord& to);

// Levels by material, null where no filter makes any: those that the scene has brought, or made here, each once.
using MaterialLevels = std::vector<std::shared_ptr<const MipLevels>>;
MaterialLevels filtered_levels(const Scene& scene, const SceneMips& mips, const Jobs& jobs, const TaughtTexels& advance = {});
bool is_metal(const Scene& scene, const Material& material); // more than half of it

// Where the filter of the material makes no levels of its maps, why: empty where it does, or has nothing to do.
std::string why_unfiltered(const Scene& scene, const Material& material, const MaterialMips& mips);
// Whether its levels have gains; what lets light through would pass no less by them.
bool has_gains(const Material& material, const MaterialMips& mips);
// What a filter makes levels of, of a material that it makes any of.
bool is_filtered(const Scene& scene, const Material& material, const MaterialMips& mips);
MipHelp mip_help(const Scene& scene, const Material& material, const MaterialMips& mips, const TaughtTexels& advance = {});
MipSource mip_source(const Scene& scene, const Material& material);
// Whether levels that were baked beforehand are of these maps and filters.
bool fits(const MipLevels& levels, const MipSource& source, std::uint64_t hash, const Scene& scene, const Material& material,
          const MaterialMips& mips);

TexturePyramid make_pyramid(const Scene& scene, const SceneMips& mips, const PyramidKey& key, const MaterialLevels& levels);

} // namespace burnish
