// Whole triangles, one per lane, fetched by id from the frame's vertices.
#pragma once
#include "core/base/column.h"
#include "core/simd/lanes.h"
#include "raster/tile/tile_types.h"

namespace burnish {
inline namespace BN_ISA_NS {

static_assert(kLanes <= kColumnPad); // whole registers are read and written at the end of lists

struct LaneTriangles {
    integer x[3], y[3], vertex[3];
    real inv_w[3], z[3];
};

BN_INLINE integer min3(const integer v[3])
{
    return min(min(v[0], v[1]), v[2]);
}
BN_INLINE integer max3(const integer v[3])
{
    return max(max(v[0], v[1]), v[2]);
}

// Loads positions. id: global ids, valid in every lane. run: ids are consecutive from `first` on.
BN_INLINE void load_positions(const FrameParams& f, integer id, bool run, std::uint32_t first, LaneTriangles& t)
{
    const std::int32_t* indices = reinterpret_cast<const std::int32_t*>(f.indices);
    if (run) {
        load_triples_int(indices + 3 * static_cast<std::size_t>(first), t.vertex);
    } else {
        for (int k = 0; k < 3; ++k)
            t.vertex[k] = gather_int(indices + k, id + id + id);
    }
    for (int k = 0; k < 3; ++k) {
        integer field[4];
        load_quads(f.vertices, t.vertex[k], field);
        t.x[k] = field[0], t.y[k] = field[1];
        t.inv_w[k] = real_from_bits(field[2]), t.z[k] = real_from_bits(field[3]);
    }
}

struct AreaSigns {
    mask positive, negative; // y points down; a front face, counter-clockwise with y up, is negative
};

// Returns the signs of the areas. Twice the signed area needs 47 bits. If all differences are below 2^15 (128 pixels), 32 bits hold it
// exactly.
BN_INLINE AreaSigns area_signs(const LaneTriangles& t, mask valid)
{
    const integer ax = t.x[1] - t.x[0], ay = t.y[1] - t.y[0], bx = t.x[2] - t.x[0], by = t.y[2] - t.y[0];
    const integer area = ax * by - bx * ay;
    const integer range = int_lit(1 << 15);
    const auto small = [&](integer d) { return both(d < range, int_lit(0) - range < d); };
    const mask is_small = both(both(small(ax), small(ay)), both(small(bx), small(by)));
    // Recompute large triangles in 64 bits
    std::uint32_t large = to_bits(both(valid, not_(is_small)));
    if (!large)
        return {area > int_lit(0), area < int_lit(0)};
    std::uint32_t positive = to_bits(area > int_lit(0)), negative = to_bits(area < int_lit(0));
    std::int32_t d[4][kLanes];
    store_int(d[0], ax), store_int(d[1], ay), store_int(d[2], bx), store_int(d[3], by);
    for (; large; large &= large - 1) {
        const int i = __builtin_ctz(large);
        const std::int64_t a = static_cast<std::int64_t>(d[0][i]) * d[3][i] - static_cast<std::int64_t>(d[2][i]) * d[1][i];
        const std::uint32_t bit = 1u << i;
        positive = a > 0 ? positive | bit : positive & ~bit;
        negative = a < 0 ? negative | bit : negative & ~bit;
    }
    return {mask_from_bits(positive), mask_from_bits(negative)};
}

// Exchanges the second and third vertices of front faces, which makes the area positive.
BN_INLINE void turn_fronts(mask front, LaneTriangles& t)
{
    const auto swap = [front](auto v[3]) {
        const auto second = v[1];
        v[1] = select(front, v[2], v[1]);
        v[2] = select(front, second, v[2]);
    };
    swap(t.x), swap(t.y), swap(t.vertex), swap(t.inv_w), swap(t.z);
}

// Prefetches data for the next two registers of triangles. Meshes are listed in runs, so a few lanes stand for all.
BN_INLINE void prefetch_triangles(const FrameParams& f, const TileScratch& s, std::uint32_t first)
{
    const auto whole = [&](std::uint32_t i) { return i < s.triangle_count && !(s.entries[i] & kClippedEntry); };
    if (const std::uint32_t i = first + 2 * kLanes; whole(i)) {
        const std::size_t id = s.entries[i];
        __builtin_prefetch(f.triangle_material + id);
        const std::uintptr_t indices = reinterpret_cast<std::uintptr_t>(f.indices + 3 * id); // later addresses may lie beyond the indices
        for (std::uintptr_t k = 0; k < 3 * 4 * kLanes; k += 64)
            __builtin_prefetch(reinterpret_cast<const void*>(indices + k));
    }
    for (std::uint32_t lane = 0; lane < kLanes; lane += 5)
        if (const std::uint32_t i = first + kLanes + lane; whole(i))
            for (std::size_t k = 0; k < 3; ++k)
                __builtin_prefetch(f.vertices + f.indices[3 * std::size_t{s.entries[i]} + k]);
}

// Loads up to kLanes triangles in the tile's list from `first` on. Whole triangles are valid in the lanes of `whole`; other lanes hold
// some triangle. Writes the whole triangles' setups.
BN_INLINE LaneTriangles load_triangles(const FrameParams& f, const TileScratch& s, std::uint32_t first, mask& whole, integer& material)
{
    prefetch_triangles(f, s, first);
    const integer entry = load_int(s.entries + first), zero = int_lit(0);
    const mask used = iota() < int_lit(static_cast<std::int32_t>(s.triangle_count - first));
    const mask clipped = both(used, entry < zero); // kClippedEntry is the sign
    whole = both(used, not_(clipped));
    const integer id = select(whole, entry, zero);
    const std::uint32_t first_id = s.entries[first];
    const bool run = all(both(whole, entry == iota() + int_lit(static_cast<std::int32_t>(first_id))));
    LaneTriangles t;
    // Load positions, and orient front faces
    load_positions(f, id, run, first_id, t);
    const mask front = area_signs(t, whole).negative;
    turn_fronts(front, t);
    const std::int32_t* materials = reinterpret_cast<const std::int32_t*>(f.triangle_material);
    material = run ? load_int(materials + first_id) : gather_int(materials, id);
    // Write the setups; pieces keep theirs
    const integer info = shl(material, 2) | select(front, int_lit(kFrontFacing), zero);
    const integer fields[16] = {t.x[0],
                                t.x[1],
                                t.x[2],
                                t.y[0],
                                t.y[1],
                                t.y[2],
                                bits_of(t.inv_w[0]),
                                bits_of(t.inv_w[1]),
                                bits_of(t.inv_w[2]),
                                bits_of(t.z[0]),
                                bits_of(t.z[1]),
                                bits_of(t.z[2]),
                                t.vertex[0],
                                t.vertex[1],
                                t.vertex[2],
                                info};
    TriangleSetup* const to = s.triangles + first;
    if (none(clipped)) {
        store_records16(to, fields);
        return t;
    }
    TriangleSetup made[kLanes];
    store_records16(made, fields);
    for (std::uint32_t bits = to_bits(whole); bits; bits &= bits - 1)
        to[__builtin_ctz(bits)] = made[__builtin_ctz(bits)];
    return t;
}

} // namespace BN_ISA_NS
} // namespace burnish
