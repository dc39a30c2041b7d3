// Operations by WebAssembly's own instructions, for lanes_portable.h.
#pragma once
#include <wasm_simd128.h>

namespace burnish {
inline namespace BN_ISA_NS {

BN_INLINE v128_t v128_of(part_f x)
{
    return __builtin_bit_cast(v128_t, x);
}
BN_INLINE v128_t v128_of(part_i x)
{
    return __builtin_bit_cast(v128_t, x);
}
BN_INLINE part_f floats_of(v128_t x)
{
    return __builtin_bit_cast(part_f, x);
}
BN_INLINE part_i ints_of(v128_t x)
{
    return __builtin_bit_cast(part_i, x);
}

BN_INLINE std::uint32_t to_bits(const mask& m)
{
    std::uint32_t bits = 0;
    BN_EACH_PART bits |= static_cast<std::uint32_t>(wasm_i32x4_bitmask(v128_of(m.p[p]))) << (4 * p);
    return bits;
}
BN_INLINE mask mask_from_bits(std::uint32_t bits)
{
    mask m;
    BN_EACH_PART
    {
        const part_i bit = {1 << (4 * p), 2 << (4 * p), 4 << (4 * p), 8 << (4 * p)};
        const int all = static_cast<int>(bits);
        m.p[p] = (part_i)((part_i{all, all, all, all} & bit) == bit);
    }
    return m;
}
BN_INLINE bool any(const mask& m)
{
    part_i on = m.p[0];
    for (int p = 1; p < kParts; ++p)
        on |= m.p[p];
    return wasm_v128_any_true(v128_of(on));
}
BN_INLINE bool all(const mask& m)
{
    part_i on = m.p[0];
    for (int p = 1; p < kParts; ++p)
        on &= m.p[p];
    return wasm_i32x4_all_true(v128_of(on));
}
BN_INLINE bool none(const mask& m)
{
    return !any(m);
}

// pmin(x, y) is y < x ? y : x.
BN_INLINE real min(const real& a, const real& b)
{
    real r;
    BN_EACH_PART r.p[p] = floats_of(wasm_f32x4_pmin(v128_of(b.p[p]), v128_of(a.p[p])));
    return r;
}
BN_INLINE real max(const real& a, const real& b)
{
    real r;
    BN_EACH_PART r.p[p] = floats_of(wasm_f32x4_pmax(v128_of(b.p[p]), v128_of(a.p[p])));
    return r;
}

#define BN_BY_PART(name, function)                                                                                                         \
    BN_INLINE real name(const real& x)                                                                                                     \
    {                                                                                                                                      \
        real r;                                                                                                                            \
        BN_EACH_PART r.p[p] = floats_of(function(v128_of(x.p[p])));                                                                        \
        return r;                                                                                                                          \
    }
BN_BY_PART(sqrt, wasm_f32x4_sqrt)
BN_BY_PART(floor, wasm_f32x4_floor)
BN_BY_PART(ceil, wasm_f32x4_ceil)
BN_BY_PART(round_to_even, wasm_f32x4_nearest)
#undef BN_BY_PART

// WebAssembly's conversion gives 0 for NaN, and the largest integer for numbers beyond.
BN_INLINE integer to_int(const real& x)
{
    integer r;
    BN_EACH_PART
    {
        const v128_t below = wasm_f32x4_lt(v128_of(x.p[p]), wasm_f32x4_splat(0x1p31f));
        r.p[p] = ints_of(wasm_v128_bitselect(wasm_i32x4_trunc_sat_f32x4(v128_of(x.p[p])), wasm_i32x4_splat(INT32_MIN), below));
    }
    return r;
}
BN_INLINE integer round_to_int(const real& x)
{
    return to_int(round_to_even(x));
}

} // namespace BN_ISA_NS
} // namespace burnish
