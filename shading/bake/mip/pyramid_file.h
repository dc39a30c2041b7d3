// Levels of materials as a file, of `burnish bake mip`. Little-endian:
//
//   bytes     what
//   8         "bnmip01" and a line feed
//   4, 4      version, 3; number of materials
//   then each material:
//   16        the filter's name, zeros after it
//   4         kappa, float; 0 where the filter has none, of mipnet that of its taps
//   4, 4, 4   width and height of level 0; number of levels that follow, from level 1 on: sides are halved and rounded down, at least 1
//   8         hash of level 0 (MipSource::hash), which is not in the file: it is what the material's maps say
//   8         levels_hash() of the weights of filters mipnet and teacher; else 0
//   4, 4      what gains are of: 0: they are 1, else 1 + 2 l + m, l the lobe (mipnet::Lobe), m 1 of metals, else 0; zero
//   4 each    gain of each level, float: what reflectances there are multiplied by (level_gains.h)
//   20 each   texels, rows from the top, level by level: x and y of the normal in tangent space, a, b, c of the lobe in that normal's frame
//             (lobe_tensor, shading/surface/tensor.k.h), floats
//   8         hash_bytes() of all before it
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/bake/mip/levels.h"

namespace burnish {

std::vector<std::uint8_t> mip_file_bytes(const std::vector<const MipLevels*>& materials);

// What is damaged, of another version, or holds what no filter makes is refused.
Result<std::vector<MipLevels>> parse_mip_file(const std::vector<std::uint8_t>& bytes, const std::string& path);

} // namespace burnish
