// Draw order of a tile's large triangles.
#pragma once
#include "core/simd/lanes.h"
#include "raster/tile/tile_types.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr std::uint32_t kSortedTriangles = 256; // above this number, draw in list order unless alpha is tested

struct SubPixelBox { // bounds of a triangle
    std::int32_t x0, y0, x1, y1;
};
BN_INLINE SubPixelBox box_of(const TriangleSetup& t)
{
    const auto least = [](const std::int32_t* v) { return v[0] < v[1] ? (v[0] < v[2] ? v[0] : v[2]) : (v[1] < v[2] ? v[1] : v[2]); };
    const auto greatest = [](const std::int32_t* v) { return v[0] > v[1] ? (v[0] > v[2] ? v[0] : v[2]) : (v[1] > v[2] ? v[1] : v[2]); };
    return {least(t.x), least(t.y), greatest(t.x), greatest(t.y)};
}
BN_INLINE bool larger_than_a_block(const SubPixelBox& b)
{
    return b.x1 - b.x0 > kBlock * kSubpixel || b.y1 - b.y0 > kBlock * kSubpixel;
}

// Estimates the pixels that a triangle covers in a tile: its box's part in the tile, times the triangle's share of its box.
BN_INLINE float covered_pixels(const TriangleSetup& t, const SubPixelBox& b, const SubPixelBox& tile)
{
    const float width = static_cast<float>((b.x1 < tile.x1 ? b.x1 : tile.x1) - (b.x0 > tile.x0 ? b.x0 : tile.x0));
    const float height = static_cast<float>((b.y1 < tile.y1 ? b.y1 : tile.y1) - (b.y0 > tile.y0 ? b.y0 : tile.y0));
    const float area = static_cast<float>(t.x[1] - t.x[0]) * static_cast<float>(t.y[2] - t.y[0]) -
                       static_cast<float>(t.x[2] - t.x[0]) * static_cast<float>(t.y[1] - t.y[0]);
    const float box = static_cast<float>(b.x1 - b.x0) * static_cast<float>(b.y1 - b.y0);
    return width > 0.0f && height > 0.0f ? width * height * (0.5f / (kSubpixel * kSubpixel)) * (area / box) : 0.0f;
}

// Returns the depth of a triangle's nearest vertex.
BN_INLINE float nearest_depth(const TriangleSetup& t)
{
    const float z = t.z[0] > t.z[1] ? t.z[0] : t.z[1];
    return t.z[2] > z ? t.z[2] : z;
}

// Sorts the n numbers in `from` by nearest[number], the nearest first. Equal depths keep their order (merge sort, runs doubling). `to` has
// room for n. Returns the sorted one of the two arrays.
BN_INLINE std::uint32_t* sort_by_depth(const float* nearest, std::uint32_t n, std::uint32_t* from, std::uint32_t* to)
{
    for (std::uint32_t run = 1; run < n; run *= 2) {
        for (std::uint32_t begin = 0; begin < n; begin += 2 * run) {
            const std::uint32_t middle = begin + run < n ? begin + run : n, end = begin + 2 * run < n ? begin + 2 * run : n;
            for (std::uint32_t a = begin, b = middle, at = begin; at < end; ++at)
                to[at] = b == end || (a < middle && nearest[from[a]] >= nearest[from[b]]) ? from[a++] : from[b++];
        }
        std::uint32_t* const swapped = from;
        from = to, to = swapped;
    }
    return from;
}

// Sorts the first n singly drawn triangles from near to far. Then blocks, and under alpha test samples, hide later surfaces before a texel
// is fetched. Returns false, and keeps the list's order, if sorting would not pay: too many or mostly small triangles, little overlap, or
// sorted already. x0, y0: the tile's corner, pixels.
BN_INLINE bool front_to_back(const FrameParams& f, const TileScratch& s, std::uint32_t n, int x0, int y0)
{
    constexpr float kLayers = 1.5f; // below this overlap, few samples are hidden
    // Reuse memory that fragments need only later
    const std::uint32_t room = static_cast<std::uint32_t>(f.tile_size * f.tile_size);
    if (n < 2 || n > room)
        return false;
    float* const nearest = s.red; // by index in the list
    std::uint32_t *order = reinterpret_cast<std::uint32_t*>(s.order), *other = reinterpret_cast<std::uint32_t*>(s.fragment_pixel);
    std::uint32_t large = 0, tested = 0;
    float covered = 0.0f;
    const std::int32_t side = f.tile_size * kSubpixel, left = x0 * kSubpixel - f.center_x, top = y0 * kSubpixel - f.center_y;
    const SubPixelBox tile = {left, top, left + side, top + side};
    bool in_order = true;
    // Find each triangle's nearest depth, and judge the gain
    for (std::uint32_t i = 0; i < n; ++i) {
        const TriangleSetup& t = s.triangles[s.drawn_singly[i]];
        nearest[i] = nearest_depth(t);
        order[i] = i;
        in_order = in_order && (i == 0 || nearest[i - 1] >= nearest[i]);
        const SubPixelBox box = box_of(t);
        large += larger_than_a_block(box);
        covered += covered_pixels(t, box, tile);
        tested += f.materials[t.info >> 2].alpha_mode != kAlpha_opaque;
    }
    if (in_order || (2 * tested < n && (n > kSortedTriangles || 2 * large < n || covered < kLayers * static_cast<float>(room))))
        return false;
    // Sort
    const std::uint32_t* const sorted = sort_by_depth(nearest, n, order, other);
    std::uint32_t* const to = sorted == order ? other : order;
    for (std::uint32_t i = 0; i < n; ++i)
        to[i] = s.drawn_singly[sorted[i]];
    __builtin_memcpy(s.drawn_singly, to, n * sizeof *to);
    return true;
}

} // namespace BN_ISA_NS
} // namespace burnish
