// The kernel language in C++ (see lang.h): vectors of lanes over the lane types of core/simd.
#pragma once
#include "core/simd/lanes.h"

#define BN_FN static inline __attribute__((always_inline, unused))
#define BN_IN(T) const T&
#define BN_INOUT(T) T&
// A stage that several techniques share: compiled once, called once a batch.
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

BN_FN real4 texel_value(texel_acc acc)
{
    real c[4];
    texel_values(acc, c);
    return {c[0], c[1], c[2], c[3]};
}

BN_KERNELS_END
