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
BN_CALL std::uint32_t to_bits(const mask& m)
{
    const int_lanes on = lanes_of(m);
    std::uint32_t bits = 0;
    BN_EACH_LANE bits |= (static_cast<std::uint32_t>(on.at[k]) & 1u) << k;
    return bits;
}
BN_CALL mask mask_from_bits(std::uint32_t bits)
{
    int_lanes on;
    BN_EACH_LANE on.at[k] = (bits >> k & 1u) != 0 ? -1 : 0;
    return __builtin_bit_cast(mask, on);
}
BN_OP bool any(const mask& m)
{
    return to_bits(m) != 0;
}
BN_OP bool all(const mask& m)
{
    return to_bits(m) == (1u << kLanes) - 1u;
}
BN_OP bool none(const mask& m)
{
    return to_bits(m) == 0;
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
BN_OP real min(const real& a, const real& b)
{
    return select(a < b, a, b);
}
BN_OP real max(const real& a, const real& b)
{
    return select(a > b, a, b);
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

#define BN_BY_LANE(name, function)                                                                                                         \
    BN_CALL real name(const real& x)                                                                                                       \
    {                                                                                                                                      \
        float_lanes r = lanes_of(x);                                                                                                       \
        BN_EACH_LANE r.at[k] = function(r.at[k]);                                                                                          \
        return real_of(r);                                                                                                                 \
    }
BN_BY_LANE(sqrt, __builtin_sqrtf)
BN_BY_LANE(floor, __builtin_floorf)
BN_BY_LANE(ceil, __builtin_ceilf)
BN_BY_LANE(round_to_even, __builtin_rintf)
#undef BN_BY_LANE

BN_OP real to_real(const integer& i)
{
    real r;
    BN_EACH_PART r.p[p] = __builtin_convertvector(i.p[p], part_f);
    return r;
}
BN_CALL integer to_int(const real& x)
{
    const mask inside = both(x >= splat(-0x1p31f), x < splat(0x1p31f));
    const real safe = select(inside, x, splat(0.0f));
    integer r;
    BN_EACH_PART r.p[p] = __builtin_convertvector(safe.p[p], part_i);
    return select(inside, r, int_lit(INT32_MIN));
}
BN_OP integer round_to_int(const real& x)
{
    return to_int(round_to_even(x));
}

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
BN_CALL integer load_first(const std::int32_t* from, int n)
{
    int_lanes r = {};
    for (int k = 0; k < kLanes && k < n; ++k)
        r.at[k] = from[k];
    return integer_of(r);
}
BN_CALL real load_first(const float* from, int n)
{
    float_lanes r = {};
    for (int k = 0; k < kLanes && k < n; ++k)
        r.at[k] = from[k];
    return real_of(r);
}
BN_CALL void store_first(std::int32_t* to, const integer& i, int n)
{
    for (int k = 0; k < kLanes && k < n; ++k)
        to[k] = lanes_of(i).at[k];
}
BN_CALL void store_first(float* to, const real& x, int n)
{
    for (int k = 0; k < kLanes && k < n; ++k)
        to[k] = lanes_of(x).at[k];
}
BN_CALL real gather(const float* base, const integer& index)
{
    float_lanes r;
    BN_EACH_LANE r.at[k] = base[lanes_of(index).at[k]];
    return real_of(r);
}
BN_CALL integer gather_int(const std::int32_t* base, const integer& index)
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
BN_CALL real load_rows(const float* first, const float* second)
{
    float_lanes r;
    BN_EACH_LANE r.at[k] = k < 8 ? first[k] : second[k - 8];
    return real_of(r);
}
BN_CALL void store_rows(float* first, float* second, const real& x)
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

// ---- arrays of structs

BN_OP const char* record_at(const void* base, const integer& index, int lane, std::size_t bytes)
{
    return static_cast<const char*>(base) + bytes * static_cast<std::uint32_t>(lanes_of(index).at[lane]);
}
template <int kWords> BN_CALL void load_words(const void* base, const integer& index, integer* out)
{
    int_lanes r[kWords];
    BN_EACH_LANE
    {
        std::int32_t words[kWords];
        __builtin_memcpy(words, record_at(base, index, k, sizeof words), sizeof words);
        for (int f = 0; f < kWords; ++f)
            r[f].at[k] = words[f];
    }
    for (int f = 0; f < kWords; ++f)
        out[f] = integer_of(r[f]);
}
template <int kWords> BN_CALL void store_words(void* base, const integer* r, int n)
{
    for (int k = 0; k < kLanes && k < n; ++k) {
        std::int32_t words[kWords];
        for (int f = 0; f < kWords; ++f)
            words[f] = lanes_of(r[f]).at[k];
        __builtin_memcpy(static_cast<char*>(base) + sizeof words * static_cast<std::size_t>(k), words, sizeof words);
    }
}
BN_OP void load_records16(const void* base, const integer& index, integer out[16])
{
    load_words<16>(base, index, out);
}
BN_OP void store_records16(void* base, const integer r[16])
{
    store_words<16>(base, r, kLanes);
}
BN_OP void load_quads(const void* base, const integer& index, integer out[4])
{
    load_words<4>(base, index, out);
}
BN_OP void store_quads(void* base, const integer r[4], int n)
{
    store_words<4>(base, r, n);
}

BN_CALL real field_of(const float* base, const integer& record)
{
    float_lanes r;
    BN_EACH_LANE __builtin_memcpy(&r.at[k], record_at(base, record, k, 64), 4);
    return real_of(r);
}
BN_CALL void blend_fields(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                          const real& b2, real* out, int fields)
{
    for (int c = 0; c < fields; ++c)
        out[c] = (b0 * field_of(base + c, i0) + b1 * field_of(base + c, i1)) + b2 * field_of(base + c, i2);
}
BN_OP void blend_records(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                         const real& b2, real out[16])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 16);
}
BN_OP void blend_records_low(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                             const real& b2, real out[8])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 8);
}
BN_OP void blend_quad(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                      const real& b2, real out[4])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 4);
}

using pair_table = const float*;
BN_CALL void load_pairs(pair_table table, const integer& index, real out[4])
{
    for (int c = 0; c < 4; ++c) {
        float_lanes r;
        BN_EACH_LANE __builtin_memcpy(&r.at[k], record_at(table + c, index, k, 8), 4);
        out[c] = real_of(r);
    }
}

using texel_buffer = const std::uint16_t*;
struct texel_acc {
    real left[4], right[4];
};
BN_OP texel_acc texel_zero()
{
    return texel_acc{};
}
// Reads a pair of texels for each lane: the left channels, then the right ones.
BN_CALL void texel_pairs(texel_buffer texels, const integer& row, real out[8])
{
    float_lanes r[8];
    BN_EACH_LANE
    {
        const std::uint16_t* t = texels + std::size_t{4} * static_cast<std::uint32_t>(lanes_of(row).at[k]);
        for (int c = 0; c < 8; ++c)
            r[c].at[k] = half_to_float(t[c]);
    }
    for (int c = 0; c < 8; ++c)
        out[c] = real_of(r[c]);
}
BN_OP void load_texel_pair(texel_buffer texels, std::uint32_t at, float out[8])
{
    for (std::size_t c = 0; c < 8; ++c)
        out[c] = half_to_float(texels[std::size_t{4} * at + c]);
}
BN_CALL texel_acc texel_add(const texel_acc& acc, texel_buffer texels, const integer& row0, const integer& row1, const real& w00,
                            const real& w10, const real& w01, const real& w11)
{
    texel_acc r;
    real t0[8], t1[8];
    texel_pairs(texels, row0, t0);
    texel_pairs(texels, row1, t1);
    for (int c = 0; c < 4; ++c) {
        r.left[c] = acc.left[c] + (w00 * t0[c] + w01 * t1[c]);
        r.right[c] = acc.right[c] + (w10 * t0[c + 4] + w11 * t1[c + 4]);
    }
    return r;
}
struct texel_plan {
    integer row0, row1;
    real w00, w10, w01, w11;
};
BN_OP void plan_texels(texel_plan& p, const integer& row0, const integer& row1, const real& w00, const real& w10, const real& w01,
                       const real& w11)
{
    p = {row0, row1, w00, w10, w01, w11};
}
BN_OP texel_acc texel_add(const texel_acc& acc, texel_buffer texels, const texel_plan& p)
{
    return texel_add(acc, texels, p.row0, p.row1, p.w00, p.w10, p.w01, p.w11);
}
BN_OP void texel_values(const texel_acc& acc, real out[4])
{
    for (int c = 0; c < 4; ++c)
        out[c] = acc.left[c] + acc.right[c];
}

#undef BN_CALL
#undef BN_OP
#undef BN_EACH_PART
#undef BN_EACH_LANE

} // namespace BN_ISA_NS
} // namespace burnish

#include "core/simd/lanes_derived.h"
#include "core/simd/lanes_plain.h"
