// File format for materials' mip levels: normals and lobes, base colours, metalness and heights.
// Level 0 is not in the file: it follows from the material's maps. Little-endian:
//
//   bytes     content
//   8         "bnmip01" and a line feed
//   4, 4      version, 4; material count
//   4, 4      map count; zero
//
//   then each material:
//   16        filter name, padded with zeros
//   4         kappa, float; 0 if the filter has none; for mipnet its taps' kappa
//   4, 4, 4   level 0's width and height; level count, from level 1 on: sides are halved and rounded down, at least 1
//   8         level 0's hash (MipSource::hash)
//   8         the weights' levels_hash() for filters mipnet and teacher; else 0
//   4, 4      the gains' kind, 0: all are 1, else 1 + 2 l + m with lobe l (mipnet::Lobe) and m = 1 for metals, else 0; zero
//   4 each    each level's gain, float: factor on its reflectances (level_gains.h)
//   20 each   texels, rows from the top, level by level, floats: the normal's x and y in tangent space; the lobe's a, b, c in that
//             normal's frame (lobe_tensor, shading/surface/tensor.k.h)
//
//   then each map, once for all materials that use it:
//   4, 4      part: 0 base colours, linear, 1 metallic-roughness as in glTF, 2 heights; kernel: 0 box, 1 kaiser
//   8, 8      level 0's hash (map_hash()); the weighting normals' hash (MipSource::hash for the normal map alone), 0: no weights
//   4, 4      level 0's width and height
//   4, 4      channels: 1 (gray, heights), 3 or 4 (alpha); level count, from level 1 on
//   2 each    level by level, rows from the top, a texel's channels side by side: halves, finite
//
//   8         hash over all bytes before: hash_bytes() over each MiB, seeded with the hash so far, 0 at first
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/result.h"
#include "shading/bake/mip/levels.h"

namespace burnish {

struct MipParts { // a file's contents
    std::vector<const MipLevels*> materials;
    std::size_t map_count = 0;
    std::function<MapLevels(std::size_t)> map; // makes a map when the map is written, because large maps fill memory
};
std::vector<std::uint8_t> mip_file_bytes(const MipParts& parts);
// Writes the file as write_file_atomic() does, one map after the other.
Status write_mip_file(const std::string& path, const MipParts& parts, Links links = Links::follow);

// Parses a file. Refuses damaged files, other versions, and contents that no filter makes.
Result<MipFile> parse_mip_file(const std::vector<std::uint8_t>& bytes, const std::string& path);

} // namespace burnish
