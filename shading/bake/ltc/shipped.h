// The table of transformed cosines that is part of the program: shading/bake/ltc/ggx.ltc, its bytes as they were when it was built.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shading/bake/ltc/table.h"

namespace burnish::ltc {

extern const std::uint32_t kShippedWords[]; // of the file, little-endian
extern const std::size_t kShippedBytes;     // a multiple of 4

// What shading reads of a table (table_texels), and what it must know of its grid: members of ltc_table (shading/lights/ltc_table.k.h).
struct ShadingTable {
    std::vector<std::uint16_t> texels;
    int root_alpha, basis;
};
const ShadingTable& shipped_table(); // made once a process

} // namespace burnish::ltc
