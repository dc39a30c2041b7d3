// Finds tiles that take long enough to leave threads idle.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burnish {

// Tiles with many triangles, largest first. The first `cut` tiles are cut into parts: whole, each would keep one thread busy while the
// others are idle.
struct TileSplit {
    std::vector<std::uint32_t> tiles;
    std::size_t cut = 0;
};
TileSplit tile_split(const std::vector<std::uint32_t>& triangles_by_tile, int threads);

} // namespace burnish
