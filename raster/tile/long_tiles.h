// Which tiles take long enough to leave threads without work.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burnish {

// The tiles of many triangles, those of most first: the first `cut` of them are cut into parts, as whole ones would keep one thread busy
// while the others have nothing left to do.
struct LongTiles {
    std::vector<std::uint32_t> tiles;
    std::size_t cut = 0;
};
LongTiles long_tiles(const std::vector<std::uint32_t>& triangles_by_tile, int threads);

} // namespace burnish
