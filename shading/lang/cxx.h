// The kernel language in C++ (see lang.h): vectors of lanes over the lane types of core/simd.
#pragma once
#include "core/simd/lanes.h"

#define BN_FN static inline __attribute__((always_inline, unused))
#define BN_IN(T) const T&
#define BN_INOUT(T) T&
// A function that several techniques share: compiled once, called once per batch.
#define BN_STAGE static __attribute__((noinline, unused))
#define BN_KERNELS_BEGIN                                                                                                                   \
    namespace burnish {                                                                                                                    \
    inline namespace BN_ISA_NS {
#define BN_KERNELS_END                                                                                                                     \
    }                                                                                                                                      \
    }

BN_KERNELS_BEGIN

using uniform_real = float;
using real_table = const float*;       // 16 readable entries
using int_table = const std::int32_t*; // 16 readable entries

struct real2 {
    real x, y;
};
struct real3 {
    real x, y, z;
};
struct real4 {
    real x, y, z, w;
};

BN_FN real2 vec2_of(real x, real y)
{
    return {x, y};
}
BN_FN real3 vec3_of(real x, real y, real z)
{
    return {x, y, z};
}
BN_FN real4 vec4_of(real x, real y, real z, real w)
{
    return {x, y, z, w};
}
BN_FN real2 vec2_all(real x)
{
    return {x, x};
}
BN_FN real3 vec3_all(real x)
{
    return {x, x, x};
}
BN_FN real4 vec4_all(real x)
{
    return {x, x, x, x};
}

#define BN_OPERATOR(op)                                                                                                                    \
    BN_FN real2 operator op(real2 a, real2 b)                                                                                              \
    {                                                                                                                                      \
        return {a.x op b.x, a.y op b.y};                                                                                                   \
    }                                                                                                                                      \
    BN_FN real3 operator op(real3 a, real3 b)                                                                                              \
    {                                                                                                                                      \
        return {a.x op b.x, a.y op b.y, a.z op b.z};                                                                                       \
    }                                                                                                                                      \
    BN_FN real4 operator op(real4 a, real4 b)                                                                                              \
    {                                                                                                                                      \
        return {a.x op b.x, a.y op b.y, a.z op b.z, a.w op b.w};                                                                           \
    }                                                                                                                                      \
    BN_FN real2 operator op(real2 a, real b)                                                                                               \
    {                                                                                                                                      \
        return {a.x op b, a.y op b};                                                                                                       \
    }                                                                                                                                      \
    BN_FN real3 operator op(real3 a, real b)                                                                                               \
    {                                                                                                                                      \
        return {a.x op b, a.y op b, a.z op b};                                                                                             \
    }                                                                                                                                      \
    BN_FN real4 operator op(real4 a, real b)                                                                                               \
    {                                                                                                                                      \
        return {a.x op b, a.y op b, a.z op b, a.w op b};                                                                                   \
    }                                                                                                                                      \
    BN_FN real2 operator op(real a, real2 b)                                                                                               \
    {                                                                                                                                      \
        return {a op b.x, a op b.y};                                                                                                       \
    }                                                                                                                                      \
    BN_FN real3 operator op(real a, real3 b)                                                                                               \
    {                                                                                                                                      \
        return {a op b.x, a op b.y, a op b.z};                                                                                             \
    }                                                                                                                                      \
    BN_FN real4 operator op(real a, real4 b)                                                                                               \
    {                                                                                                                                      \
        return {a op b.x, a op b.y, a op b.z, a op b.w};                                                                                   \
    }                                                                                                                                      \
    BN_FN real2& operator op##=(real2& a, real2 b)                                                                                         \
    {                                                                                                                                      \
        return a = a op b;                                                                                                                 \
    }                                                                                                                                      \
    BN_FN real3& operator op##=(real3& a, real3 b)                                                                                         \
    {                                                                                                                                      \
        return a = a op b;                                                                                                                 \
    }                                                                                                                                      \
    BN_FN real4& operator op##=(real4& a, real4 b)                                                                                         \
    {                                                                                                                                      \
        return a = a op b;                                                                                                                 \
    }                                                                                                                                      \
    BN_FN real2& operator op##=(real2& a, real b)                                                                                          \
    {                                                                                                                                      \
        return a = a op b;                                                                                                                 \
    }                                                                                                                                      \
    BN_FN real3& operator op##=(real3& a, real b)                                                                                          \
    {                                                                                                                                      \
        return a = a op b;                                                                                                                 \
    }                                                                                                                                      \
    BN_FN real4& operator op##=(real4& a, real b)                                                                                          \
    {                                                                                                                                      \
        return a = a op b;                                                                                                                 \
    }
BN_OPERATOR(+)
BN_OPERATOR(-)
BN_OPERATOR(*)
BN_OPERATOR(/)
#undef BN_OPERATOR

BN_FN real2 operator-(real2 a)
{
    return {-a.x, -a.y};
}
BN_FN real3 operator-(real3 a)
{
    return {-a.x, -a.y, -a.z};
}
BN_FN real4 operator-(real4 a)
{
    return {-a.x, -a.y, -a.z, -a.w};
}

#define BN_BY_COMPONENT(name)                                                                                                              \
    BN_FN real2 name(real2 a, real2 b)                                                                                                     \
    {                                                                                                                                      \
        return {name(a.x, b.x), name(a.y, b.y)};                                                                                           \
    }                                                                                                                                      \
    BN_FN real3 name(real3 a, real3 b)                                                                                                     \
    {                                                                                                                                      \
        return {name(a.x, b.x), name(a.y, b.y), name(a.z, b.z)};                                                                           \
    }                                                                                                                                      \
    BN_FN real4 name(real4 a, real4 b)                                                                                                     \
    {                                                                                                                                      \
        return {name(a.x, b.x), name(a.y, b.y), name(a.z, b.z), name(a.w, b.w)};                                                           \
    }
BN_BY_COMPONENT(min)
BN_BY_COMPONENT(max)
#undef BN_BY_COMPONENT

BN_FN real2 clamp(real2 a, real2 lo, real2 hi)
{
    return min(max(a, lo), hi);
}
BN_FN real3 clamp(real3 a, real3 lo, real3 hi)
{
    return min(max(a, lo), hi);
}
BN_FN real4 clamp(real4 a, real4 lo, real4 hi)
{
    return min(max(a, lo), hi);
}
BN_FN real2 abs(real2 a)
{
    return {abs(a.x), abs(a.y)};
}
BN_FN real3 abs(real3 a)
{
    return {abs(a.x), abs(a.y), abs(a.z)};
}
BN_FN real4 abs(real4 a)
{
    return {abs(a.x), abs(a.y), abs(a.z), abs(a.w)};
}

BN_FN real2 select(mask m, real2 a, real2 b)
{
    return {select(m, a.x, b.x), select(m, a.y, b.y)};
}
BN_FN real3 select(mask m, real3 a, real3 b)
{
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
BN_FN real4 select(mask m, real4 a, real4 b)
{
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z), select(m, a.w, b.w)};
}

#define any_wide auto // a wide, or one double for all lanes
BN_FN wide wide_like(wide, double x)
{
    return wide_lit(x);
}
BN_FN double wide_like(double, double x)
{
    return x;
}

BN_FN bool any_lane(mask m)
{
    return any(m);
}
BN_FN bool no_lane(mask m)
{
    return none(m);
}
BN_FN uniform_real most_of_lanes(real x)
{
    float most[kLanes];
    store(most, reduce_max(x));
    return most[0];
}

BN_FN real4 pairs_at(pair_table table, integer index)
{
    real p[4];
    load_pairs(table, index, p);
    return vec4_of(p[0], p[1], p[2], p[3]);
}
BN_FN real4 texel_value(texel_acc acc)
{
    real c[4];
    texel_values(acc, c);
    return {c[0], c[1], c[2], c[3]};
}

struct texel_cell {
    integer first;
    int pair[4], row, plane;
    real w00[4], w10[4], w01[4], w11[4];
};
struct texel_planes {
    real4 plane[3];
};

// Adds up one cell for all lanes, as if every lane had this `first`. All lanes share the texels, so nothing is loaded or
// reordered by lane.
BN_STAGE void texel_cell_shared(texel_buffer texels, const texel_cell& cell, std::int32_t first, real out[12])
{
    float texel[3][4][2][8];
    for (int plane = 0; plane < 3; ++plane)
        for (int k = 0; k < 4; ++k)
            for (int row = 0; row < 2; ++row)
                load_texel_pair(texels, static_cast<std::uint32_t>(first + plane * cell.plane + cell.pair[k] + row * cell.row),
                                texel[plane][k][row]);
    for (int i = 0; i < 12; ++i) {
        const int c = i & 3;
        real left = lit(0.0), right = lit(0.0);
        for (int k = 0; k < 4; ++k) {
            const float* const t0 = texel[i >> 2][k][0] + c;
            const float* const t1 = texel[i >> 2][k][1] + c;
            left = left + (cell.w00[k] * splat(t0[0]) + cell.w01[k] * splat(t1[0]));
            right = right + (cell.w10[k] * splat(t0[4]) + cell.w11[k] * splat(t1[4]));
        }
        out[i] = left + right;
    }
}

// Adds up each lane's own cell.
BN_STAGE void texel_cell_by_lane(texel_buffer texels, const texel_cell& cell, real out[12])
{
    for (int plane = 0; plane < 3; ++plane) {
        texel_acc acc = texel_zero();
        for (int k = 0; k < 4; ++k) {
            const integer row0 = cell.first + int_lit(plane * cell.plane + cell.pair[k]);
            acc = texel_add(acc, texels, row0, row0 + int_lit(cell.row), cell.w00[k], cell.w10[k], cell.w01[k], cell.w11[k]);
        }
        texel_values(acc, out + 4 * plane);
    }
}

// Returns the weighted sum over a cell, by plane. Neighbouring fragments mostly share one cell or two, so those cells are
// loaded once for all lanes.
BN_FN texel_planes texel_cell_value(texel_buffer texels, const texel_cell& cell)
{
    constexpr int kMostShared = kLanes == 1 ? 0 : 2; // cells; beyond this number, fetches by lane are faster
    constexpr std::uint32_t kAll = (1u << kLanes) - 1u;
    std::int32_t first[kLanes];
    store_int(first, cell.first);
    real c[12] = {};
    std::uint32_t open = kAll;
    // Count the distinct cells, up to the limit
    for (int n = 0; n < kMostShared && open != 0; ++n)
        open &= ~to_bits(cell.first == int_lit(first[__builtin_ctz(open)]));
    if (open != 0) {
        texel_cell_by_lane(texels, cell, c);
    } else {
        // Load each distinct cell once and select by lane
        for (open = kAll; open != 0;) {
            const std::int32_t at = first[__builtin_ctz(open)];
            const mask here = cell.first == int_lit(at);
            open &= ~to_bits(here);
            real of_cell[12];
            texel_cell_shared(texels, cell, at, of_cell);
            for (int i = 0; i < 12; ++i)
                c[i] = select(here, of_cell[i], c[i]);
        }
    }
    return {{{c[0], c[1], c[2], c[3]}, {c[4], c[5], c[6], c[7]}, {c[8], c[9], c[10], c[11]}}};
}

BN_KERNELS_END
