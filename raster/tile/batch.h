// kLanes fragments with one material: their places and colours.
#pragma once
#include "raster/tile/fragment.h"
#include "raster/tile/visible.h"
#include "shading/lang/lang.h"

namespace burnish {
inline namespace BN_ISA_NS {

// kLanes fragments with one material.
struct Batch {
    std::int32_t fragment[kLanes];
    int n;
    bool run;                        // all lanes in use, by consecutive fragments in the list
    std::int32_t common;             // the triangle of all fragments, or kManyTriangles
    integer x, y, samples, triangle; // pixel in the image, covered samples, triangle in the tile's list
};

BN_INLINE Batch load_batch(const Tile& t, std::uint32_t at, std::uint32_t end)
{
    // Find out if the fragments are consecutive
    Batch b;
    b.n = static_cast<int>(end - at < kLanes ? end - at : kLanes);
    const std::int32_t* order = t.s.order + at;
    std::int32_t in_list[kLanes];
    std::int32_t first = static_cast<std::int32_t>(at);
    b.run = b.n == kLanes;
    if (!t.s.in_list_order) {
        first = order[0];
        b.run = b.run && order[kLanes - 1] - first == kLanes - 1; // the order is ascending
    } else if (!b.run) {
        store_int(in_list, iota() + int_lit(first));
        order = in_list;
    }
    // Load or gather the fragments
    integer pixel;
    if (b.run) {
        b.fragment[0] = first;
        pixel = load_int(t.s.fragment_pixel + first);
        b.samples = load_int(t.s.fragment_mask + first);
        b.triangle = load_int(t.s.fragment_triangle + first);
    } else {
        for (int i = 0; i < kLanes; ++i) // spare lanes repeat the first fragment
            b.fragment[i] = order[i < b.n ? i : 0];
        const integer index = load_int(b.fragment);
        pixel = gather_int(t.s.fragment_pixel, index);
        b.samples = gather_int(t.s.fragment_mask, index);
        b.triangle = gather_int(t.s.fragment_triangle, index);
    }
    b.x = (pixel & int_lit(255)) + int_lit(t.x0);
    b.y = shr(pixel, 8) + int_lit(t.y0);
    b.common = t.s.fragment_triangle[first];
    if (!all(b.triangle == int_lit(b.common)))
        b.common = kManyTriangles;
    return b;
}

BN_INLINE void store_batch(const Tile& t, const Batch& b, const real3& color)
{
    if (b.run) {
        const std::int32_t to = b.fragment[0];
        store(t.s.red + to, color.x), store(t.s.green + to, color.y), store(t.s.blue + to, color.z);
        return;
    }
    float r[kLanes], g[kLanes], bl[kLanes];
    store(r, color.x), store(g, color.y), store(bl, color.z);
    for (int i = 0; i < b.n; ++i) {
        const std::int32_t to = b.fragment[i];
        t.s.red[to] = r[i], t.s.green[to] = g[i], t.s.blue[to] = bl[i];
    }
}

} // namespace BN_ISA_NS
} // namespace burnish
