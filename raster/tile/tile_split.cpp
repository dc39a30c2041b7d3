#include "raster/tile/tile_split.h"

#include <algorithm>

namespace burnish {

TileSplit tile_split(const std::vector<std::uint32_t>& triangles_by_tile, int threads)
{
    constexpr std::uint64_t kWorthCutting = 8192; // triangles
    TileSplit found;
    if (threads == 1)
        return found;
    const std::uint64_t workers = static_cast<std::uint64_t>(threads);
    std::uint64_t all = 0;
    for (std::uint32_t count : triangles_by_tile)
        all += count;
    const std::uint64_t share = std::max(all / (8 * workers), kWorthCutting);
    for (std::size_t i = 0; i < triangles_by_tile.size(); ++i)
        if (triangles_by_tile[i] > share)
            found.tiles.push_back(static_cast<std::uint32_t>(i));
    std::stable_sort(found.tiles.begin(), found.tiles.end(),
                     [&](std::uint32_t l, std::uint32_t r) { return triangles_by_tile[l] > triangles_by_tile[r]; });
    // Simulates the draw: whole tiles go to the thread with the least work, and cut tiles fill the gaps.
    const std::uint64_t most = (all + all / 16) / workers;
    for (; found.cut < found.tiles.size(); ++found.cut) {
        std::vector<std::uint64_t> load(workers);
        for (std::size_t k = found.cut; k < found.tiles.size(); ++k)
            *std::min_element(load.begin(), load.end()) += triangles_by_tile[found.tiles[k]];
        if (*std::max_element(load.begin(), load.end()) <= most)
            break;
    }
    return found;
}

} // namespace burnish
