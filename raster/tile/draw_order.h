// In which order a tile draws its large triangles.
#pragma once
#include "core/simd/lanes.h"
#include "raster/tile/tile_types.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr std::uint32_t kSortedTriangles = 256; // more of them are drawn as they come, unless their alpha is tested

BN_INLINE bool larger_than_a_block(const TriangleSetup& t)
{
    const auto span = [](const std::int32_t* v) {
        const std::int32_t lo = v[0] < v[1] ? v[0] : v[1], hi = v[0] > v[1] ? v[0] : v[1];
        return (hi > v[2] ? hi : v[2]) - (lo < v[2] ? lo : v[2]);
    };
    return span(t.x) > kBlock * kSubpixel || span(t.y) > kBlock * kSubpixel;
}

// Sorts the first n triangles that are drawn singly, the nearest first, so that what lies behind is hidden by the block, and where alpha is
// tested by the sample, before a texel is fetched; equal ones stay in turn (merge sort, runs doubling). False where that is not worth while
// and they stay in the list's order: many triangles, mostly small ones, or in order already.
BN_INLINE bool front_to_back(const FrameParams& f, const TileScratch& s, std::uint32_t n)
{
    // what is a fragment's later serves here
    const std::uint32_t room = static_cast<std::uint32_t>(f.tile_size * f.tile_size);
    if (n < 2 || n > room)
        return false;
    float* const nearest = s.red; // by place in the list
    std::uint32_t *from = reinterpret_cast<std::uint32_t*>(s.order), *to = reinterpret_cast<std::uint32_t*>(s.fragment_pixel);
    std::uint32_t large = 0, tested = 0;
    bool in_order = true;
    for (std::uint32_t i = 0; i < n; ++i) {
        const TriangleSetup& t = s.triangles[s.drawn_singly[i]];
        const float key = t.z[0] > t.z[1] ? t.z[0] : t.z[1];
        nearest[i] = t.z[2] > key ? t.z[2] : key;
        from[i] = i;
        in_order = in_order && (i == 0 || nearest[i - 1] >= nearest[i]);
        large += larger_than_a_block(t);
        tested += f.materials[t.info >> 2].alpha_mode != kAlpha_opaque;
    }
    if (in_order || (2 * tested < n && (n > kSortedTriangles || 2 * large < n)))
        return false;
    for (std::uint32_t run = 1; run < n; run *= 2) {
        for (std::uint32_t begin = 0; begin < n; begin += 2 * run) {
            const std::uint32_t middle = begin + run < n ? begin + run : n, end = begin + 2 * run < n ? begin + 2 * run : n;
            for (std::uint32_t a = begin, b = middle, at = begin; at < end; ++at)
                to[at] = b == end || (a < middle && nearest[from[a]] >= nearest[from[b]]) ? from[a++] : from[b++];
        }
        std::uint32_t* const swapped = from;
        from = to, to = swapped;
    }
    for (std::uint32_t i = 0; i < n; ++i)
        to[i] = s.drawn_singly[from[i]];
    __builtin_memcpy(s.drawn_singly, to, n * sizeof *to);
    return true;
}

} // namespace BN_ISA_NS
} // namespace burnish
