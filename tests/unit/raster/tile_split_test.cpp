// Tiles that are split into parts.
#include <gtest/gtest.h>

#include "raster/tile/tile_split.h"

namespace burnish {
namespace {

using Counts = std::vector<std::uint32_t>;

// Returns `small` tiles with `each` triangles around some others.
Counts beside(const Counts& others, std::size_t small, std::uint32_t each)
{
    Counts counts(small, each);
    counts.insert(counts.begin() + static_cast<std::ptrdiff_t>(small / 2), others.begin(), others.end());
    return counts;
}

TEST(tile_split, are_left_whole_where_they_fill_all_threads)
{
    const TileSplit found = tile_split(beside({240000, 250000, 245000, 245000}, 500, 1), 2);
    EXPECT_EQ(found.cut, 0u);
    EXPECT_EQ(found.tiles, (Counts{251, 252, 253, 250}));          // largest first, equal ones in order
    EXPECT_EQ(tile_split(beside({300000}, 1000, 700), 3).cut, 0u); // as long as the others' remaining work
}

TEST(tile_split, are_cut_where_whole_ones_would_leave_a_thread_idle)
{
    EXPECT_EQ(tile_split(beside({900000}, 500, 10), 2).cut, 1u);
    EXPECT_EQ(tile_split(beside({250000, 250000, 250000}, 500, 10), 2).cut, 1u); // two stay whole, both threads share the third
    EXPECT_EQ(tile_split(beside({250000, 250000, 250000}, 500, 10), 8).cut, 3u);
}

TEST(tile_split, are_none_of_few_triangles_or_of_one_thread)
{
    EXPECT_TRUE(tile_split(beside({8000, 8000}, 0, 0), 2).tiles.empty());
    EXPECT_TRUE(tile_split(beside({900000}, 500, 10), 1).tiles.empty());
    EXPECT_TRUE(tile_split(Counts(510, 20000), 2).tiles.empty());
    EXPECT_TRUE(tile_split({}, 4).tiles.empty());
}

} // namespace
} // namespace burnish
