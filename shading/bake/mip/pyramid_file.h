// Levels of materials as a file, of `burnish bake mip`: normals and lobes, base colours, metalness and heights. Level 0 is not in the file:
// it is what the material's maps say. Little-endian:
//
//   bytes     what
//   8         "bnmip01" and a line feed
//   4, 4      version, 4; number of materials
//   4, 4      number of maps; zero
//   then each material:
//   16        the filter's name, zeros after it
//   4         kappa, float; 0 where the filter has none, of mipnet that of its taps
//   4, 4, 4   width and height of level 0; number of levels that follow, from level 1 on: sides are halved and rounded down, at least 1
//   8         hash of level 0 (MipSource::hash)
//   8         levels_hash() of the weights of filters mipnet and teacher; else 0
//   4, 4      what gains are of: 0: they are 1, else 1 + 2 l + m, l the lobe (mipnet::Lobe), m 1 of metals, else 0; zero
//   4 each    gain of each level, float: what reflectances there are multiplied by (level_gains.h)
//   20 each   texels, rows from the top, level by level: x and y of the normal in tangent space, a, b, c of the lobe in that normal's frame
//             (lobe_tensor, shading/surface/tensor.k.h), floats
//   then each map, once for all materials that have it:
//   4, 4      what it is: 0 base colours, linear, 1 metallic-roughness as glTF has it, 2 heights; what it is averaged by: 0 box, 1 kaiser
//   8, 8      hash of level 0 (map_hash()); hash of the normals that weigh its texels (MipSource::hash of the normal map alone), 0: none do
//   4, 4      width and height of level 0
//   4, 4      channels: 1 (gray, heights), 3 or 4 (alpha); number of levels that follow, from level 1 on
//   2 each    level by level, rows from the top, channels of a texel side by side: halves, finite
//   8         hash of all before it: hash_bytes() of each MiB, with the hash of what is before it as its seed, 0 at first
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/result.h"
#include "shading/bake/mip/levels.h"

namespace burnish {

struct MipParts { // of a file
    std::vector<const MipLevels*> materials;
    std::size_t map_count = 0;
    std::function<MapLevels(std::size_t)> map; // made where it is written, not before: large ones fill the memory
};
std::vector<std::uint8_t> mip_file_bytes(const MipParts& parts);
// As write_file_atomic() does, one map after the other.
Status write_mip_file(const std::string& path, const MipParts& parts, Links links = Links::follow);

// What is damaged, of another version, or holds what no filter makes is refused.
Result<MipFile> parse_mip_file(const std::vector<std::uint8_t>& bytes, const std::string& path);

} // namespace burnish
