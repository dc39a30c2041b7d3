// Numbers with derivatives, over lanes: a `dual` carries five derivatives forward. Templates over this type, or over `real` itself, serve
// for values and gradients.
#pragma once
#include "shading/kernels/math_special.k.h"

BN_KERNELS_BEGIN
namespace mipnet_lanes {

using burnish::max;
using burnish::min;
using burnish::select;
using burnish::sqrt;

#ifdef BN_ORACLE
using number = double;
BN_FN real get(const number* from)
{
    return *from;
}
BN_FN void put(number* to, real x)
{
    *to = x;
}
BN_FN real all_lanes(number x)
{
    return x;
}
BN_FN real exp_of(real x)
{
    return __builtin_exp(x);
}
BN_FN real log_of(real x)
{
    return __builtin_log(x);
}
BN_FN real log1p_of(real x)
{
    return __builtin_log1p(x);
}
#else
using number = float;
BN_FN real get(const number* from)
{
    return load(from);
}
BN_FN void put(number* to, real x)
{
    store(to, x);
}
BN_FN real all_lanes(number x)
{
    return splat(x);
}
BN_FN real exp_of(real x)
{
    return k_exp(x);
}
BN_FN real log_of(real x)
{
    return k_log2(x) * lit(0.69314718055994531);
}
BN_FN real log1p_of(real x)
{
    return k_log1p(x);
}
#endif

BN_FN real value(real x)
{
    return x;
}

struct dual {
    real v, d0, d1, d2, d3, d4;
};
BN_FN real value(const dual& x)
{
    return x.v;
}
BN_FN dual constant(real v)
{
    const real zero = lit(0.0);
    return {v, zero, zero, zero, zero, zero};
}
// Returns the number v with derivative da by a, and db by b.
BN_FN dual chain(real v, const dual& a, real da)
{
    return {v, a.d0 * da, a.d1 * da, a.d2 * da, a.d3 * da, a.d4 * da};
}
BN_FN dual chain(real v, const dual& a, real da, const dual& b, real db)
{
    return {v, a.d0 * da + b.d0 * db, a.d1 * da + b.d1 * db, a.d2 * da + b.d2 * db, a.d3 * da + b.d3 * db, a.d4 * da + b.d4 * db};
}

// Arithmetic over a type with value() and chain().
#define BN_DIFFERENTIABLE(D)                                                                                                               \
    BN_FN D operator+(const D& a, const D& b)                                                                                              \
    {                                                                                                                                      \
        return chain(value(a) + value(b), a, lit(1.0), b, lit(1.0));                                                                       \
    }                                                                                                                                      \
    BN_FN D operator-(const D& a, const D& b)                                                                                              \
    {                                                                                                                                      \
        return chain(value(a) - value(b), a, lit(1.0), b, lit(-1.0));                                                                      \
    }                                                                                                                                      \
    BN_FN D operator*(const D& a, const D& b)                                                                                              \
    {                                                                                                                                      \
        return chain(value(a) * value(b), a, value(b), b, value(a));                                                                       \
    }                                                                                                                                      \
    BN_FN D operator/(const D& a, const D& b)                                                                                              \
    {                                                                                                                                      \
        const real inverse = lit(1.0) / value(b), ratio = value(a) * inverse;                                                              \
        return chain(ratio, a, inverse, b, -(ratio * inverse));                                                                            \
    }                                                                                                                                      \
    BN_FN D operator-(const D& a)                                                                                                          \
    {                                                                                                                                      \
        return chain(-value(a), a, lit(-1.0));                                                                                             \
    }                                                                                                                                      \
    BN_FN D operator+(const D& a, real b)                                                                                                  \
    {                                                                                                                                      \
        return chain(value(a) + b, a, lit(1.0));                                                                                           \
    }                                                                                                                                      \
    BN_FN D operator+(real a, const D& b)                                                                                                  \
    {                                                                                                                                      \
        return chain(a + value(b), b, lit(1.0));                                                                                           \
    }                                                                                                                                      \
    BN_FN D operator-(const D& a, real b)                                                                                                  \
    {                                                                                                                                      \
        return chain(value(a) - b, a, lit(1.0));                                                                                           \
    }                                                                                                                                      \
    BN_FN D operator-(real a, const D& b)                                                                                                  \
    {                                                                                                                                      \
        return chain(a - value(b), b, lit(-1.0));                                                                                          \
    }                                                                                                                                      \
    BN_FN D operator*(const D& a, real b)                                                                                                  \
    {                                                                                                                                      \
        return chain(value(a) * b, a, b);                                                                                                  \
    }                                                                                                                                      \
    BN_FN D operator*(real a, const D& b)                                                                                                  \
    {                                                                                                                                      \
        return chain(a * value(b), b, a);                                                                                                  \
    }                                                                                                                                      \
    BN_FN D operator/(real a, const D& b)                                                                                                  \
    {                                                                                                                                      \
        const real inverse = lit(1.0) / value(b), ratio = a * inverse;                                                                     \
        return chain(ratio, b, -(ratio * inverse));                                                                                        \
    }                                                                                                                                      \
    BN_FN D sqrt(const D& a) /* a > 0 */                                                                                                   \
    {                                                                                                                                      \
        const real root = sqrt(value(a));                                                                                                  \
        return chain(root, a, lit(0.5) / root);                                                                                            \
    }                                                                                                                                      \
    BN_FN D exp_of(const D& a)                                                                                                             \
    {                                                                                                                                      \
        const real e = exp_of(value(a));                                                                                                   \
        return chain(e, a, e);                                                                                                             \
    }                                                                                                                                      \
    BN_FN D log_of(const D& a)                                                                                                             \
    {                                                                                                                                      \
        return chain(log_of(value(a)), a, lit(1.0) / value(a));                                                                            \
    }                                                                                                                                      \
    BN_FN D log1p_of(const D& a)                                                                                                           \
    {                                                                                                                                      \
        return chain(log1p_of(value(a)), a, lit(1.0) / (lit(1.0) + value(a)));                                                             \
    }                                                                                                                                      \
    BN_FN D max(const D& a, real b)                                                                                                        \
    {                                                                                                                                      \
        return chain(max(value(a), b), a, select(value(a) > b, lit(1.0), lit(0.0)));                                                       \
    }                                                                                                                                      \
    BN_FN D min(const D& a, real b)                                                                                                        \
    {                                                                                                                                      \
        return chain(min(value(a), b), a, select(value(a) < b, lit(1.0), lit(0.0)));                                                       \
    }                                                                                                                                      \
    BN_FN D max(const D& a, const D& b)                                                                                                    \
    {                                                                                                                                      \
        const mask first = value(a) > value(b);                                                                                            \
        return chain(max(value(a), value(b)), a, select(first, lit(1.0), lit(0.0)), b, select(first, lit(0.0), lit(1.0)));                 \
    }                                                                                                                                      \
    BN_FN D min(const D& a, const D& b)                                                                                                    \
    {                                                                                                                                      \
        const mask first = value(a) < value(b);                                                                                            \
        return chain(min(value(a), value(b)), a, select(first, lit(1.0), lit(0.0)), b, select(first, lit(0.0), lit(1.0)));                 \
    }
BN_DIFFERENTIABLE(dual)

} // namespace mipnet_lanes
BN_KERNELS_END
