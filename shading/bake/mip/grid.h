// A common grid for maps with several sizes, and map reads at its points.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/scene/scene.h"
#include "shading/bake/mip/texture.h"

namespace burnish {

struct Grid { // the result's size, and the maps' interpolation
    int width = 0, height = 0;
    WrapMode wrap_s = WrapMode::repeat, wrap_t = WrapMode::repeat;
    bool nearest = false;

    void cover(const Image* map) // as wide as the widest map, as high as the highest
    {
        if (map)
            width = std::max(width, map->width), height = std::max(height, map->height);
    }
};

// The two texels in a row or column beside a grid point, and the second one's share.
struct Neighbours {
    int low, high;
    float share;
};
inline Neighbours neighbours(int at, int count, int texels, WrapMode wrap, bool nearest)
{
    if (count == texels)
        return {at, at, 0.0f};
    const double place = (at + 0.5) * texels / count;
    if (nearest)
        return {static_cast<int>(place), static_cast<int>(place), 0.0f};
    const int low = static_cast<int>(std::floor(place - 0.5));
    const auto inside = [&](int i) { return wrap == WrapMode::repeat ? (i + texels) % texels : std::clamp(i, 0, texels - 1); };
    return {inside(low), inside(low + 1), static_cast<float>(place - 0.5 - low)};
}

// Returns a map's quantity at a grid point. value: the quantity at a texel, by index.
template <class Value> float on_grid(const Image& map, const Grid& grid, int x, int y, const Value& value)
{
    const Neighbours u = neighbours(x, grid.width, map.width, grid.wrap_s, grid.nearest);
    const Neighbours v = neighbours(y, grid.height, map.height, grid.wrap_t, grid.nearest);
    const auto row = [&](int at) {
        const std::size_t first = static_cast<std::size_t>(at) * static_cast<std::size_t>(map.width);
        const float low = value(first + static_cast<std::size_t>(u.low));
        return u.share == 0.0f ? low : low + u.share * (value(first + static_cast<std::size_t>(u.high)) - low);
    };
    const float low = row(v.low);
    return v.share == 0.0f ? low : low + v.share * (row(v.high) - low);
}

struct TexelShare { // a texel's or row's weight in a finer level
    int at;
    double weight;
};
// Returns the `source` texels that texel i in `target` covers, with exact overlaps.
inline std::vector<TexelShare> shares_of(int i, int source, int target)
{
    std::vector<TexelShare> shares;
    const std::int64_t s = source, t = target; // units of 1 / target texels of the source
    for (std::int64_t k = i * s / t; k < ((i + 1) * s + t - 1) / t; ++k) {
        const std::int64_t overlap = std::min((k + 1) * t, (i + 1) * s) - std::max(k * t, i * s);
        shares.push_back({static_cast<int>(k), static_cast<double>(overlap) / static_cast<double>(s)});
    }
    return shares;
}

// Returns the level count from 1 on. Sides are halved and rounded down, at least 1.
inline int levels_below(int width, int height)
{
    int levels = 0;
    while (levels + 1 < kMaxTextureLevels && (std::max(width, height) >> (levels + 1)) > 0)
        ++levels;
    return levels;
}

// Returns the finer level that level l is made from: the smallest level whose texels tile l's footprints, or level 0.
inline int finer_level(int width, int height, int l)
{
    const auto side = [](int of, int level) { return std::max(1, of >> level); };
    int from = l - 1;
    while (from > 0 && (side(width, from) % side(width, l) != 0 || side(height, from) % side(height, l) != 0))
        --from;
    return from;
}

// Counts the levels that can be made in row bands, because their sides halve without remainder. Later levels need only the
// last one.
inline int banded_levels(int width, int height)
{
    constexpr int kMostBanded = 5;
    int levels = 0;
    while (levels < kMostBanded && (width >> levels) % 2 == 0 && (height >> levels) % 2 == 0)
        ++levels;
    const auto stays = [&](int banded) {
        for (int l = banded + 1; l <= levels_below(width, height); ++l)
            if (finer_level(width, height, l) < banded)
                return false;
        return true;
    };
    while (levels > 0 && !stays(levels))
        --levels;
    return levels;
}

} // namespace burnish
