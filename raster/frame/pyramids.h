// Which texture pyramids the materials of a scene need, and what they are made of. A slot of a material holds an image as it is, tensors of
// an anisotropy texture, or, in their place, moments of slopes:
//   of all, where a map of tilts lies over one of anisotropy and roughness is the same everywhere: the texels' lobes are in them
//   of tilts, where there is a map of them else: beside the lobe of the material, and in frames that override roughness or anisotropy;
//     or of normals, in a material that is `lean`
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scene/scene.h"
#include "shading/bake/mip/texture.h"
#include "shading/lang/tables.h"

namespace burnish {

struct PyramidKey {
    std::int32_t texture; // its sampler, and without moments its image
    TextureEncoding encoding;
    int tensor_power;              // 2, 4: tensors of an anisotropy texture, or a part of moments; 0: the image itself
    int moments = kNoMoments;      // kMomentsOfTilt...
    std::int32_t material = kNone; // whose moments: the first of those that have them in common
    bool operator==(const PyramidKey&) const = default;
};

std::vector<PyramidKey> used_pyramids(const Scene& scene); // each once

// Textures, by their places in `keys`, and moments of a material. overridden: in frames that override roughness or anisotropy.
void bind_textures(const Scene& scene, std::size_t material, bool overridden, const std::vector<PyramidKey>& keys, MaterialRecord& to);

TexturePyramid make_pyramid(const Scene& scene, const PyramidKey& key);

} // namespace burnish
