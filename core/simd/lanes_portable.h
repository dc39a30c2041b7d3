// Lanes without intrinsics: kLanes floats in parts of four, as GCC and Clang vector extensions. Nearly every processor
// holds four floats in a register. Larger vector types are slow on processors without such registers, and partly wrong
// under clang 14. lanes_scalar.h defines the operations. lanes_portable8.h and lanes_portable16.h set kLanes. A mask
// holds all ones or all zeros in each lane.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/half.h"

// Loops over lanes stay calls: inlined everywhere, their code would fill megabytes.
#define BN_CALL static __attribute__((noinline, unused))
// Short loops too, unless the machine's own code for them is short.
#ifdef __wasm_simd128__
#define BN_SHORT BN_INLINE
#else
#define BN_SHORT BN_CALL
#endif
#ifdef BN_PORTABLE_CALLS // every operation is a call
#define BN_OP BN_CALL
#else
#define BN_OP BN_INLINE
#endif

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr int kParts = kLanes / 4;
#define BN_EACH_PART for (int p = 0; p < kParts; ++p)
#define BN_EACH_LANE for (int k = 0; k < kLanes; ++k)

using part_f = float __attribute__((vector_size(16)));
using part_i = std::int32_t __attribute__((vector_size(16)));
using part_u = std::uint32_t __attribute__((vector_size(16)));

struct real {
    part_f p[kParts];
};
struct integer {
    part_i p[kParts];
};
struct mask {
    part_i p[kParts];
};
// Lanes in memory, for loops over single lanes.
struct float_lanes {
    float at[kLanes];
};
struct int_lanes {
    std::int32_t at[kLanes];
};
BN_OP float_lanes lanes_of(const real& x)
{
    return __builtin_bit_cast(float_lanes, x);
}
BN_OP int_lanes lanes_of(const integer& i)
{
    return __builtin_bit_cast(int_lanes, i);
}
BN_OP int_lanes lanes_of(const mask& m)
{
    return __builtin_bit_cast(int_lanes, m);
}
BN_OP real real_of(const float_lanes& x)
{
    return __builtin_bit_cast(real, x);
}
BN_OP integer integer_of(const int_lanes& i)
{
    return __builtin_bit_cast(integer, i);
}

BN_OP real splat(float x)
{
    real r;
    BN_EACH_PART r.p[p] = part_f{x, x, x, x};
    return r;
}
BN_OP real lit(double x)
{
    return splat(static_cast<float>(x));
}
BN_OP integer int_lit(int x)
{
    integer r;
    BN_EACH_PART r.p[p] = part_i{x, x, x, x};
    return r;
}
BN_OP integer iota()
{
    integer r;
    BN_EACH_PART r.p[p] = part_i{4 * p, 4 * p + 1, 4 * p + 2, 4 * p + 3};
    return r;
}

#define BN_BINARY(R, op, A, a_, b_)                                                                                                        \
    BN_OP R operator op(const A& a, const A& b)                                                                                            \
    {                                                                                                                                      \
        R r;                                                                                                                               \
        BN_EACH_PART r.p[p] = (part_i)(a_ a.p[p] op b_ b.p[p]);                                                                            \
        return r;                                                                                                                          \
    }
#define BN_REAL(op)                                                                                                                        \
    BN_OP real operator op(const real& a, const real& b)                                                                                   \
    {                                                                                                                                      \
        real r;                                                                                                                            \
        BN_EACH_PART r.p[p] = a.p[p] op b.p[p];                                                                                            \
        return r;                                                                                                                          \
    }
BN_REAL(+)
BN_REAL(-)
BN_REAL(*)
BN_REAL(/)
BN_BINARY(mask, <, real, , )
BN_BINARY(mask, <=, real, , )
BN_BINARY(mask, >, real, , )
BN_BINARY(mask, >=, real, , )
BN_BINARY(mask, ==, real, , )
BN_BINARY(mask, !=, real, , )
BN_BINARY(integer, +, integer, (part_u), (part_u))
BN_BINARY(integer, -, integer, (part_u), (part_u))
BN_BINARY(integer, *, integer, (part_u), (part_u))
BN_BINARY(integer, &, integer, , )
BN_BINARY(integer, |, integer, , )
BN_BINARY(integer, ^, integer, , )
BN_BINARY(mask, <, integer, , )
BN_BINARY(mask, <=, integer, , )
BN_BINARY(mask, >, integer, , )
BN_BINARY(mask, >=, integer, , )
BN_BINARY(mask, ==, integer, , )
BN_BINARY(mask, !=, integer, , )
#undef BN_REAL
#undef BN_BINARY

BN_OP integer bits_of(const real& x)
{
    return __builtin_bit_cast(integer, x);
}
BN_OP real real_from_bits(const integer& i)
{
    return __builtin_bit_cast(real, i);
}
BN_OP real operator-(const real& a)
{
    return real_from_bits(bits_of(a) ^ int_lit(INT32_MIN));
}
BN_OP integer operator-(const integer& a)
{
    return int_lit(0) - a;
}
BN_OP integer operator~(const integer& a)
{
    return a ^ int_lit(-1);
}
BN_OP integer shl(const integer& i, int n)
{
    integer r;
    BN_EACH_PART r.p[p] = (part_i)((part_u)i.p[p] << n);
    return r;
}
BN_OP integer shr(const integer& i, int n)
{
    integer r;
    BN_EACH_PART r.p[p] = i.p[p] >> n;
    return r;
}
BN_OP integer shr_logical(const integer& i, int n)
{
    integer r;
    BN_EACH_PART r.p[p] = (part_i)((part_u)i.p[p] >> n);
    return r;
}

BN_OP mask both(const mask& a, const mask& b)
{
    mask r;
    BN_EACH_PART r.p[p] = a.p[p] & b.p[p];
    return r;
}
BN_OP mask either(const mask& a, const mask& b)
{
    mask r;
    BN_EACH_PART r.p[p] = a.p[p] | b.p[p];
    return r;
}
BN_OP mask not_(const mask& a)
{
    mask r;
    BN_EACH_PART r.p[p] = ~a.p[p];
    return r;
}
BN_OP integer select(const mask& m, const integer& a, const integer& b)
{
    integer r;
    BN_EACH_PART r.p[p] = (m.p[p] & a.p[p]) | (~m.p[p] & b.p[p]);
    return r;
}
BN_OP real select(const mask& m, const real& a, const real& b)
{
    return real_from_bits(select(m, bits_of(a), bits_of(b)));
}
BN_OP mask select(const mask& m, const mask& a, const mask& b)
{
    mask r;
    BN_EACH_PART r.p[p] = (m.p[p] & a.p[p]) | (~m.p[p] & b.p[p]);
    return r;
}
BN_OP integer min(const integer& a, const integer& b)
{
    return select(a < b, a, b);
}
BN_OP integer max(const integer& a, const integer& b)
{
    return select(a > b, a, b);
}
BN_OP real abs(const real& x)
{
    return real_from_bits(bits_of(x) & int_lit(INT32_MAX));
}

BN_OP real to_real(const integer& i)
{
    real r;
    BN_EACH_PART r.p[p] = __builtin_convertvector(i.p[p], part_f);
    return r;
}
} // namespace BN_ISA_NS
} // namespace burnish
#ifdef __wasm_simd128__
#include "core/simd/lanes_wasm_parts.h"
#else
#include "core/simd/lanes_portable_parts.h"
#endif
namespace burnish {
inline namespace BN_ISA_NS {

// A double in each lane, for the few values beyond single precision.
struct wide {
    double at[kLanes];
};
#define BN_WIDE(op)                                                                                                                        \
    BN_CALL wide operator op(const wide& a, const wide& b)                                                                                 \
    {                                                                                                                                      \
        wide r;                                                                                                                            \
        BN_EACH_LANE r.at[k] = a.at[k] op b.at[k];                                                                                         \
        return r;                                                                                                                          \
    }
BN_WIDE(+)
BN_WIDE(-)
BN_WIDE(*)
BN_WIDE(/)
#undef BN_WIDE
BN_CALL wide wide_lit(double x)
{
    wide r;
    BN_EACH_LANE r.at[k] = x;
    return r;
}
BN_CALL wide to_wide(const integer& i)
{
    wide r;
    BN_EACH_LANE r.at[k] = static_cast<double>(lanes_of(i).at[k]);
    return r;
}
BN_CALL wide to_wide(const real& x)
{
    wide r;
    BN_EACH_LANE r.at[k] = static_cast<double>(lanes_of(x).at[k]);
    return r;
}
BN_CALL real to_real(const wide& x)
{
    float_lanes r;
    BN_EACH_LANE r.at[k] = static_cast<float>(x.at[k]);
    return real_of(r);
}

BN_OP real load(const float* from)
{
    real r;
    __builtin_memcpy(&r, from, sizeof r);
    return r;
}
BN_OP void store(float* to, const real& x)
{
    __builtin_memcpy(to, &x, sizeof x);
}
BN_OP integer load_int(const std::int32_t* from)
{
    integer r;
    __builtin_memcpy(&r, from, sizeof r);
    return r;
}
BN_OP integer load_int(const std::uint32_t* from)
{
    integer r;
    __builtin_memcpy(&r, from, sizeof r);
    return r;
}
BN_OP void store_int(std::int32_t* to, const integer& i)
{
    __builtin_memcpy(to, &i, sizeof i);
}
BN_OP void store_int(std::uint32_t* to, const integer& i)
{
    __builtin_memcpy(to, &i, sizeof i);
}
BN_SHORT integer load_first(const std::int32_t* from, int n)
{
    if (n >= kLanes)
        return load_int(from);
    int_lanes r = {};
    for (int k = 0; k < kLanes && k < n; ++k)
        r.at[k] = from[k];
    return integer_of(r);
}
BN_SHORT real load_first(const float* from, int n)
{
    if (n >= kLanes)
        return load(from);
    float_lanes r = {};
    for (int k = 0; k < kLanes && k < n; ++k)
        r.at[k] = from[k];
    return real_of(r);
}
BN_SHORT void store_first(std::int32_t* to, const integer& i, int n)
{
    if (n >= kLanes)
        return store_int(to, i);
    for (int k = 0; k < kLanes && k < n; ++k)
        to[k] = lanes_of(i).at[k];
}
BN_SHORT void store_first(float* to, const real& x, int n)
{
    if (n >= kLanes)
        return store(to, x);
    for (int k = 0; k < kLanes && k < n; ++k)
        to[k] = lanes_of(x).at[k];
}
BN_SHORT real gather(const float* base, const integer& index)
{
    float_lanes r;
    BN_EACH_LANE r.at[k] = base[lanes_of(index).at[k]];
    return real_of(r);
}
BN_SHORT integer gather_int(const std::int32_t* base, const integer& index)
{
    int_lanes r;
    BN_EACH_LANE r.at[k] = base[lanes_of(index).at[k]];
    return integer_of(r);
}
BN_OP real table_value(const float* table, const integer& index)
{
    return gather(table, index);
}
BN_OP integer table_int(const std::int32_t* table, const integer& index)
{
    return gather_int(table, index);
}
BN_CALL int compress_store_int(std::int32_t* to, const integer& i, const mask& m)
{
    int count = 0;
    BN_EACH_LANE if (lanes_of(m).at[k] != 0) to[count++] = lanes_of(i).at[k];
    return count;
}
BN_CALL integer expand_load_int(const std::int32_t* from, const mask& m)
{
    int_lanes r;
    BN_EACH_LANE r.at[k] = lanes_of(m).at[k] != 0 ? *from++ : 0;
    return integer_of(r);
}
BN_CALL real expand_load(const float* from, const mask& m)
{
    float_lanes r;
    BN_EACH_LANE r.at[k] = lanes_of(m).at[k] != 0 ? *from++ : 0.0f;
    return real_of(r);
}
BN_SHORT real load_rows(const float* first, const float* second)
{
    float_lanes r;
    BN_EACH_LANE r.at[k] = k < 8 ? first[k] : second[k - 8];
    return real_of(r);
}
BN_SHORT void store_rows(float* first, float* second, const real& x)
{
    BN_EACH_LANE(k < 8 ? first : second - 8)[k] = lanes_of(x).at[k];
}
BN_CALL void store_triples(float* first, float* second, const real& r, const real& g, const real& b)
{
    BN_EACH_LANE
    {
        float* to = k < 8 ? first + 3 * k : second + 3 * (k - 8);
        to[0] = lanes_of(r).at[k], to[1] = lanes_of(g).at[k], to[2] = lanes_of(b).at[k];
    }
}
BN_CALL void load_triples_int(const std::int32_t* from, integer out[3])
{
    for (int c = 0; c < 3; ++c) {
        int_lanes r;
        BN_EACH_LANE r.at[k] = from[3 * k + c];
        out[c] = integer_of(r);
    }
}

#define BN_FOLD(name, fold)                                                                                                                \
    BN_CALL real name(const real& x)                                                                                                       \
    {                                                                                                                                      \
        float_lanes r = lanes_of(x);                                                                                                       \
        for (int n = kLanes / 2; n > 0; n /= 2)                                                                                            \
            for (int k = 0; k < n; ++k) {                                                                                                  \
                const float a = r.at[k], b = r.at[k + n];                                                                                  \
                r.at[k] = fold;                                                                                                            \
            }                                                                                                                              \
        return splat(r.at[0]);                                                                                                             \
    }
BN_FOLD(reduce_min, a < b ? a : b)
BN_FOLD(reduce_max, a > b ? a : b)
BN_FOLD(reduce_add, a + b)
#undef BN_FOLD

} // namespace BN_ISA_NS
} // namespace burnish
#ifdef __wasm_simd128__
#include "core/simd/lanes_wasm_records.h"
#else
#include "core/simd/lanes_portable_records.h"
#endif
#undef BN_CALL
#undef BN_SHORT
#undef BN_OP
#undef BN_EACH_PART
#undef BN_EACH_LANE

#include "core/simd/lanes_derived.h"
#include "core/simd/lanes_plain.h"
