// One lane. Defines every operation; each instruction set must equal this one bit for bit. `integer` wraps because the
// files are compiled with -fwrapv. lanes_oracle.h, lanes_counted.h and lanes_mutated.h build other one-lane sets from this file.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/simd/half.h"
#ifdef BN_COUNTED
#include "core/simd/counted.h"
#define BN_COUNT(operations_, bytes_) (lane_counts.operations += (operations_), lane_counts.bytes += (bytes_))
#else
#define BN_COUNT(operations_, bytes_) static_cast<void>(0)
#endif

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr int kLanes = 1;

#ifdef BN_ORACLE
using real = double;
#elif defined(BN_COUNTED)
using real = Counted;
#else
using real = float;
#endif
using integer = std::int32_t;
using mask = bool;

BN_INLINE real splat(float x)
{
    return static_cast<real>(x);
}
#ifdef BN_ORACLE
BN_INLINE real lit(double x)
{
    return x;
}
#else
BN_INLINE real lit(double x)
{
    return static_cast<real>(static_cast<float>(x));
}
#endif
BN_INLINE integer int_lit(int x)
{
    return x;
}
BN_INLINE integer iota()
{
    return 0;
}

BN_INLINE integer shl(integer i, int n)
{
    return static_cast<integer>(static_cast<std::uint32_t>(i) << n);
}
BN_INLINE integer shr(integer i, int n)
{
    return i >> n;
}
BN_INLINE integer shr_logical(integer i, int n)
{
    return static_cast<integer>(static_cast<std::uint32_t>(i) >> n);
}

BN_INLINE mask both(mask a, mask b)
{
    return a && b;
}
BN_INLINE mask either(mask a, mask b)
{
    return a || b;
}
BN_INLINE mask not_(mask a)
{
    return !a;
}
BN_INLINE bool any(mask m)
{
    return m;
}
BN_INLINE bool all(mask m)
{
    return m;
}
BN_INLINE bool none(mask m)
{
    return !m;
}
BN_INLINE std::uint32_t to_bits(mask m)
{
    return m ? 1u : 0u;
}
BN_INLINE mask mask_from_bits(std::uint32_t bits)
{
    return (bits & 1u) != 0;
}

BN_INLINE real select(mask m, real a, real b)
{
    return m ? a : b;
}
BN_INLINE integer select(mask m, integer a, integer b)
{
    return m ? a : b;
}
BN_INLINE mask select(mask m, mask a, mask b)
{
    return m ? a : b;
}

BN_INLINE real min(real a, real b)
{
    return a < b ? a : b;
}
BN_INLINE real max(real a, real b)
{
    return a > b ? a : b;
}
BN_INLINE integer min(integer a, integer b)
{
    return a < b ? a : b;
}
BN_INLINE integer max(integer a, integer b)
{
    return a > b ? a : b;
}
BN_INLINE real clamp(real x, real lo, real hi)
{
    return min(max(x, lo), hi);
}
BN_INLINE integer clamp(integer x, integer lo, integer hi)
{
    return min(max(x, lo), hi);
}

#ifdef BN_ORACLE
BN_INLINE real abs(real x)
{
    return __builtin_fabs(x);
}
BN_INLINE real sqrt(real x)
{
    return __builtin_sqrt(x);
}
BN_INLINE real floor(real x)
{
    return __builtin_floor(x);
}
BN_INLINE real ceil(real x)
{
    return __builtin_ceil(x);
}
BN_INLINE integer to_int(real x)
{
    return x > -2147483649.0 && x < 2147483648.0 ? static_cast<integer>(x) : INT32_MIN;
}
BN_INLINE integer round_to_int(real x)
{
    return to_int(__builtin_rint(x));
}
#else
BN_INLINE real abs(real x)
{
    return static_cast<real>(__builtin_fabsf(static_cast<float>(x)));
}
BN_INLINE real sqrt(real x)
{
    BN_COUNT(1, 0);
    return static_cast<real>(__builtin_sqrtf(static_cast<float>(x)));
}
BN_INLINE real floor(real x)
{
    return static_cast<real>(__builtin_floorf(static_cast<float>(x)));
}
BN_INLINE real ceil(real x)
{
    return static_cast<real>(__builtin_ceilf(static_cast<float>(x)));
}
BN_INLINE integer to_int(real x)
{
    const float f = static_cast<float>(x);
    return f >= -0x1p31f && f < 0x1p31f ? static_cast<integer>(f) : INT32_MIN;
}
BN_INLINE integer round_to_int(real x) // ties to even
{
    return to_int(static_cast<real>(__builtin_rintf(static_cast<float>(x))));
}
#endif
BN_INLINE real to_real(integer i)
{
    return static_cast<real>(i);
}
// The oracle also sees the 32 bits of a float, so that the same code finds exponents.
BN_INLINE integer bits_of(real x)
{
    return __builtin_bit_cast(std::int32_t, static_cast<float>(x));
}
BN_INLINE real real_from_bits(integer i)
{
    return static_cast<real>(__builtin_bit_cast(float, i));
}

// A double in each lane, for the few values beyond single precision.
struct wide {
    double v;
};
BN_INLINE wide operator+(wide a, wide b)
{
    return {a.v + b.v};
}
BN_INLINE wide operator-(wide a, wide b)
{
    return {a.v - b.v};
}
BN_INLINE wide operator*(wide a, wide b)
{
    return {a.v * b.v};
}
BN_INLINE wide operator/(wide a, wide b)
{
    return {a.v / b.v};
}
BN_INLINE wide wide_lit(double x)
{
    return {x};
}
BN_INLINE wide to_wide(integer i)
{
    return {static_cast<double>(i)};
}
BN_INLINE wide to_wide(real x)
{
    return {static_cast<double>(static_cast<float>(x))};
}
BN_INLINE real to_real(wide x)
{
    return static_cast<real>(static_cast<float>(x.v));
}

BN_INLINE real load(const float* from)
{
    BN_COUNT(0, 4);
    return static_cast<real>(*from);
}
BN_INLINE void store(float* to, real x)
{
    *to = static_cast<float>(x);
}
#ifdef BN_ORACLE
BN_INLINE void store(double* to, real x)
{
    *to = x;
}
#endif
BN_INLINE integer load_int(const std::int32_t* from)
{
    return *from;
}
BN_INLINE integer load_int(const std::uint32_t* from)
{
    return static_cast<integer>(*from);
}
BN_INLINE void store_int(std::int32_t* to, integer i)
{
    *to = i;
}
BN_INLINE void store_int(std::uint32_t* to, integer i)
{
    *to = static_cast<std::uint32_t>(i);
}
BN_INLINE real load_first(const float* from, int n)
{
    return static_cast<real>(n > 0 ? *from : 0.0f);
}
BN_INLINE integer load_first(const std::int32_t* from, int n)
{
    return n > 0 ? *from : 0;
}
BN_INLINE void store_first(float* to, real x, int n)
{
    if (n > 0)
        store(to, x);
}
BN_INLINE void store_first(std::int32_t* to, integer i, int n)
{
    if (n > 0)
        *to = i;
}
BN_INLINE real gather(const float* base, integer index)
{
    BN_COUNT(0, 4);
    return static_cast<real>(base[index]);
}
BN_INLINE integer gather_int(const std::int32_t* base, integer index)
{
    return base[index];
}
BN_INLINE real table_value(const float* table, integer index)
{
    return static_cast<real>(table[index]);
}
BN_INLINE integer table_int(const std::int32_t* table, integer index)
{
    return table[index];
}
BN_INLINE int compress_store_int(std::int32_t* to, integer i, mask m)
{
    if (m)
        *to = i;
    return m ? 1 : 0;
}

// Inverse of compress_store_int: lanes of m read consecutive numbers, the others read 0. May read kLanes numbers.
BN_INLINE real expand_load(const float* from, mask m)
{
    return m ? static_cast<real>(*from) : lit(0.0);
}
BN_INLINE integer expand_load_int(const std::int32_t* from, mask m)
{
    return m ? *from : 0;
}
// Lanes 0 to 7 are at `first`, the others at `second`.
BN_INLINE real load_rows(const float* first, const float*)
{
    return static_cast<real>(*first);
}
BN_INLINE void store_rows(float* first, float*, real x)
{
    *first = static_cast<float>(x);
}
// Stores RGB triples: lanes 0 to 7 from `first` on, the others from `second` on.
BN_INLINE void store_triples(float* first, float*, real r, real g, real b)
{
    first[0] = static_cast<float>(r), first[1] = static_cast<float>(g), first[2] = static_cast<float>(b);
}

// Loads kLanes consecutive triples: out[k] holds element k of each.
BN_INLINE void load_triples_int(const std::int32_t* from, integer out[3])
{
    out[0] = from[0], out[1] = from[1], out[2] = from[2];
}

BN_INLINE real reduce_min(real x)
{
    return x;
}
BN_INLINE real reduce_max(real x)
{
    return x;
}
BN_INLINE real reduce_add(real x)
{
    return x;
}

// Loads one record a lane. Record i is 16 words (64 bytes, any alignment) at base + 64 i; out[f] is field f of record
// index[lane].
BN_INLINE void load_records16(const void* base, integer index, integer out[16])
{
    const char* record = static_cast<const char*>(base) + std::size_t{64} * static_cast<std::uint32_t>(index);
    for (int f = 0; f < 16; ++f)
        __builtin_memcpy(&out[f], record + 4 * f, 4);
}

// Stores kLanes consecutive 16-word records.
BN_INLINE void store_records16(void* base, const integer r[16])
{
    __builtin_memcpy(base, r, 64);
}
// Loads one quad a lane. Quad i is 4 words (16 bytes) at base + 16 i.
BN_INLINE void load_quads(const void* base, integer index, integer out[4])
{
    __builtin_memcpy(out, static_cast<const char*>(base) + std::size_t{16} * static_cast<std::uint32_t>(index), 16);
}
// Stores the first n quads consecutively.
BN_INLINE void store_quads(void* base, const integer r[4], int n)
{
    if (n > 0)
        __builtin_memcpy(base, r, 16);
}

// Blends three records: out[c] = (b0 r0[c] + b1 r1[c]) + b2 r2[c], rounded in that order, for the first `fields`
// floats. r0, r1, r2 are the records i0, i1, i2. Records are 16 floats apart.
BN_INLINE void blend_fields(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real* out, int fields)
{
    const float* r0 = base + std::size_t{16} * static_cast<std::uint32_t>(i0);
    const float* r1 = base + std::size_t{16} * static_cast<std::uint32_t>(i1);
    const float* r2 = base + std::size_t{16} * static_cast<std::uint32_t>(i2);
    BN_COUNT(0, 12 * static_cast<unsigned>(fields));
    for (int c = 0; c < fields; ++c)
        out[c] = (b0 * static_cast<real>(r0[c]) + b1 * static_cast<real>(r1[c])) + b2 * static_cast<real>(r2[c]);
}
BN_INLINE void blend_records(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[16])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 16);
}
BN_INLINE void blend_records_low(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[8])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 8);
}
// Blends four floats. `base` already points at the wanted field of record 0.
BN_INLINE void blend_quad(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[4])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 4);
}

// Loads pairs `index` and `index` + 1 from a table of float pairs: one unaligned 16-byte load.
using pair_table = const float*;
BN_INLINE void load_pairs(pair_table table, integer index, real out[4])
{
    BN_COUNT(0, 16);
    for (std::size_t k = 0; k < 4; ++k)
        out[k] = static_cast<real>(table[std::size_t{2} * static_cast<std::uint32_t>(index) + k]);
}

// Texels are four halves (RGBA), 8 bytes. row0 and row1 index the left texels of two horizontal pairs: the upper and
// lower rows of a bilinear footprint. Weights are named w<column><row>. A pair is one unaligned 16-byte load.
using texel_buffer = const std::uint16_t*;
struct texel_acc {
    real left[4], right[4];
};
BN_INLINE real texel_word(std::uint16_t half)
{
    return static_cast<real>(half_to_float(half));
}
BN_INLINE texel_acc texel_zero()
{
    return texel_acc{};
}
// Loads a texel pair that all lanes share: the left channels, then the right ones.
BN_INLINE void load_texel_pair(texel_buffer texels, std::uint32_t at, float out[8])
{
    for (std::size_t c = 0; c < 8; ++c)
        out[c] = half_to_float(texels[std::size_t{4} * at + c]);
}
// Adds, for each channel, left += w00 t[row0] + w01 t[row1] and right += w10 t[row0 + 1] + w11 t[row1 + 1], rounded in
// that order.
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, integer row0, integer row1, real w00, real w10, real w01, real w11)
{
    const std::uint16_t* t0 = texels + std::size_t{4} * static_cast<std::uint32_t>(row0);
    const std::uint16_t* t1 = texels + std::size_t{4} * static_cast<std::uint32_t>(row1);
    BN_COUNT(0, 32);
    for (int c = 0; c < 4; ++c) {
        acc.left[c] = acc.left[c] + (w00 * texel_word(t0[c]) + w01 * texel_word(t1[c]));
        acc.right[c] = acc.right[c] + (w10 * texel_word(t0[c + 4]) + w11 * texel_word(t1[c + 4]));
    }
    return acc;
}
// Arguments of a later texel_add, in memory: planned loads do not wait for their addresses.
struct texel_plan {
    integer row0, row1;
    real w00, w10, w01, w11;
};
BN_INLINE void plan_texels(texel_plan& p, integer row0, integer row1, real w00, real w10, real w01, real w11)
{
    p = {row0, row1, w00, w10, w01, w11};
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, const texel_plan& p)
{
    return texel_add(acc, texels, p.row0, p.row1, p.w00, p.w10, p.w01, p.w11);
}
// Returns left + right for each channel. (Kernels use texel_value, which returns a real4.)
BN_INLINE void texel_values(texel_acc acc, real out[4])
{
    for (int c = 0; c < 4; ++c)
        out[c] = acc.left[c] + acc.right[c];
}

} // namespace BN_ISA_NS
} // namespace burnish

#include "core/simd/lanes_plain.h"
