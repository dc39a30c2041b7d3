// Sixteen lanes: AVX-512 F, BW, DQ, VL. lanes_scalar.h defines the operations.
#pragma once
#include <cstddef>
#include <cstdint>

// GCC 12 warns about the deliberately undefined operands inside its own intrinsics.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>
#pragma GCC diagnostic pop

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr int kLanes = 16;

struct real {
    __m512 v;
};
struct integer {
    __m512i v;
};
struct mask {
    __mmask16 v;
};

BN_INLINE real splat(float x)
{
    return {_mm512_set1_ps(x)};
}
BN_INLINE real lit(double x)
{
    return {_mm512_set1_ps(static_cast<float>(x))};
}
BN_INLINE integer int_lit(int x)
{
    return {_mm512_set1_epi32(x)};
}
BN_INLINE integer iota()
{
    return {_mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)};
}

BN_INLINE real operator+(real a, real b)
{
    return {_mm512_add_ps(a.v, b.v)};
}
BN_INLINE real operator-(real a, real b)
{
    return {_mm512_sub_ps(a.v, b.v)};
}
BN_INLINE real operator*(real a, real b)
{
    return {_mm512_mul_ps(a.v, b.v)};
}
BN_INLINE real operator/(real a, real b)
{
    return {_mm512_div_ps(a.v, b.v)};
}
BN_INLINE real operator-(real a)
{
    return {_mm512_xor_ps(a.v, _mm512_set1_ps(-0.0f))};
}
BN_INLINE mask operator<(real a, real b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
BN_INLINE mask operator<=(real a, real b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)};
}
BN_INLINE mask operator>(real a, real b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GT_OQ)};
}
BN_INLINE mask operator>=(real a, real b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GE_OQ)};
}
BN_INLINE mask operator==(real a, real b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_EQ_OQ)};
}
BN_INLINE mask operator!=(real a, real b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_NEQ_UQ)};
}

BN_INLINE integer operator+(integer a, integer b)
{
    return {_mm512_add_epi32(a.v, b.v)};
}
BN_INLINE integer operator-(integer a, integer b)
{
    return {_mm512_sub_epi32(a.v, b.v)};
}
BN_INLINE integer operator*(integer a, integer b)
{
    return {_mm512_mullo_epi32(a.v, b.v)};
}
BN_INLINE integer operator-(integer a)
{
    return {_mm512_sub_epi32(_mm512_setzero_si512(), a.v)};
}
BN_INLINE integer operator&(integer a, integer b)
{
    return {_mm512_and_si512(a.v, b.v)};
}
BN_INLINE integer operator|(integer a, integer b)
{
    return {_mm512_or_si512(a.v, b.v)};
}
BN_INLINE integer operator^(integer a, integer b)
{
    return {_mm512_xor_si512(a.v, b.v)};
}
BN_INLINE integer operator~(integer a)
{
    return {_mm512_xor_si512(a.v, _mm512_set1_epi32(-1))};
}
BN_INLINE mask operator<(integer a, integer b)
{
    return {_mm512_cmplt_epi32_mask(a.v, b.v)};
}
BN_INLINE mask operator<=(integer a, integer b)
{
    return {_mm512_cmple_epi32_mask(a.v, b.v)};
}
BN_INLINE mask operator>(integer a, integer b)
{
    return {_mm512_cmpgt_epi32_mask(a.v, b.v)};
}
BN_INLINE mask operator>=(integer a, integer b)
{
    return {_mm512_cmpge_epi32_mask(a.v, b.v)};
}
BN_INLINE mask operator==(integer a, integer b)
{
    return {_mm512_cmpeq_epi32_mask(a.v, b.v)};
}
BN_INLINE mask operator!=(integer a, integer b)
{
    return {_mm512_cmpneq_epi32_mask(a.v, b.v)};
}
BN_INLINE integer shl(integer i, int n)
{
    return {_mm512_slli_epi32(i.v, static_cast<unsigned>(n))};
}
BN_INLINE integer shr(integer i, int n)
{
    return {_mm512_srai_epi32(i.v, static_cast<unsigned>(n))};
}
BN_INLINE integer shr_logical(integer i, int n)
{
    return {_mm512_srli_epi32(i.v, static_cast<unsigned>(n))};
}
BN_INLINE integer count_bits4(integer i)
{
    const __m128i bits = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4); // the lanes' upper bytes are 0
    return {_mm512_shuffle_epi8(_mm512_broadcast_i32x4(bits), i.v)};
}

BN_INLINE mask both(mask a, mask b)
{
    return {static_cast<__mmask16>(a.v & b.v)};
}
BN_INLINE mask either(mask a, mask b)
{
    return {static_cast<__mmask16>(a.v | b.v)};
}
BN_INLINE mask not_(mask a)
{
    return {static_cast<__mmask16>(~static_cast<unsigned>(a.v))};
}
BN_INLINE bool any(mask m)
{
    return m.v != 0;
}
BN_INLINE bool all(mask m)
{
    return m.v == 0xffff;
}
BN_INLINE bool none(mask m)
{
    return m.v == 0;
}
BN_INLINE std::uint32_t to_bits(mask m)
{
    return m.v;
}
BN_INLINE mask mask_from_bits(std::uint32_t bits)
{
    return {static_cast<__mmask16>(bits)};
}

BN_INLINE real select(mask m, real a, real b)
{
    return {_mm512_mask_blend_ps(m.v, b.v, a.v)};
}
BN_INLINE integer select(mask m, integer a, integer b)
{
    return {_mm512_mask_blend_epi32(m.v, b.v, a.v)};
}
BN_INLINE mask select(mask m, mask a, mask b)
{
    return {static_cast<__mmask16>((m.v & a.v) | (~static_cast<unsigned>(m.v) & b.v))};
}

// minps and maxps return the second operand where either is NaN or both are zero: exactly a < b ? a : b.
BN_INLINE real min(real a, real b)
{
    return {_mm512_min_ps(a.v, b.v)};
}
BN_INLINE real max(real a, real b)
{
    return {_mm512_max_ps(a.v, b.v)};
}
BN_INLINE integer min(integer a, integer b)
{
    return {_mm512_min_epi32(a.v, b.v)};
}
BN_INLINE integer max(integer a, integer b)
{
    return {_mm512_max_epi32(a.v, b.v)};
}
BN_INLINE real abs(real x)
{
    return {_mm512_andnot_ps(_mm512_set1_ps(-0.0f), x.v)};
}
BN_INLINE real sqrt(real x)
{
    return {_mm512_sqrt_ps(x.v)};
}
BN_INLINE real floor(real x)
{
    return {_mm512_roundscale_ps(x.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC)};
}
BN_INLINE real ceil(real x)
{
    return {_mm512_roundscale_ps(x.v, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC)};
}

BN_INLINE real to_real(integer i)
{
    return {_mm512_cvtepi32_ps(i.v)};
}
BN_INLINE integer to_int(real x)
{
    return {_mm512_cvttps_epi32(x.v)};
}
BN_INLINE integer round_to_int(real x)
{
    return {_mm512_cvtps_epi32(x.v)};
}
BN_INLINE integer bits_of(real x)
{
    return {_mm512_castps_si512(x.v)};
}
BN_INLINE real real_from_bits(integer i)
{
    return {_mm512_castsi512_ps(i.v)};
}

BN_INLINE __mmask16 first_lanes(int n)
{
    return static_cast<__mmask16>(n >= kLanes ? 0xffffu : n <= 0 ? 0u : (1u << n) - 1u);
}

BN_INLINE real load(const float* from)
{
    return {_mm512_loadu_ps(from)};
}
BN_INLINE void store(float* to, real x)
{
    _mm512_storeu_ps(to, x.v);
}
BN_INLINE integer load_int(const std::int32_t* from)
{
    return {_mm512_loadu_si512(from)};
}
BN_INLINE integer load_int(const std::uint32_t* from)
{
    return {_mm512_loadu_si512(from)};
}
BN_INLINE void store_int(std::int32_t* to, integer i)
{
    _mm512_storeu_si512(to, i.v);
}
BN_INLINE void store_int(std::uint32_t* to, integer i)
{
    _mm512_storeu_si512(to, i.v);
}
BN_INLINE real load_first(const float* from, int n)
{
    return {_mm512_maskz_loadu_ps(first_lanes(n), from)};
}
BN_INLINE integer load_first(const std::int32_t* from, int n)
{
    return {_mm512_maskz_loadu_epi32(first_lanes(n), from)};
}
BN_INLINE void store_first(float* to, real x, int n)
{
    _mm512_mask_storeu_ps(to, first_lanes(n), x.v);
}
BN_INLINE void store_first(std::int32_t* to, integer i, int n)
{
    _mm512_mask_storeu_epi32(to, first_lanes(n), i.v);
}
BN_INLINE real gather(const float* base, integer index)
{
    return {_mm512_i32gather_ps(index.v, base, 4)};
}
BN_INLINE integer gather_int(const std::int32_t* base, integer index)
{
    return {_mm512_i32gather_epi32(index.v, base, 4)};
}
BN_INLINE real table_value(const float* table, integer index)
{
    return {_mm512_permutexvar_ps(index.v, _mm512_loadu_ps(table))};
}
BN_INLINE integer table_int(const std::int32_t* table, integer index)
{
    return {_mm512_permutexvar_epi32(index.v, _mm512_loadu_si512(table))};
}
// Compresses in a register first, because the compressing store is microcoded on Zen 4.
BN_INLINE int compress_store_int(std::int32_t* to, integer i, mask m)
{
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(m.v, i.v));
    return __builtin_popcount(m.v);
}

BN_INLINE real expand_load(const float* from, mask m)
{
    return {_mm512_maskz_expand_ps(m.v, _mm512_loadu_ps(from))};
}
BN_INLINE integer expand_load_int(const std::int32_t* from, mask m)
{
    return {_mm512_maskz_expand_epi32(m.v, _mm512_loadu_si512(from))};
}
BN_INLINE real load_rows(const float* first, const float* second)
{
    return {_mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(first)), _mm256_loadu_ps(second), 1)};
}
BN_INLINE void store_rows(float* first, float* second, real x)
{
    _mm256_storeu_ps(first, _mm512_castps512_ps256(x.v));
    _mm256_storeu_ps(second, _mm512_extractf32x8_ps(x.v, 1));
}
BN_INLINE void store_triples(float* first, float* second, real r, real g, real b)
{
    const __m512i r_to = _mm512_setr_epi32(0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15, 10, 5),
                  g_to = _mm512_setr_epi32(5, 0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15, 10),
                  b_to = _mm512_setr_epi32(10, 5, 0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15);
    const __m512 rs = _mm512_permutexvar_ps(r_to, r.v), gs = _mm512_permutexvar_ps(g_to, g.v), bs = _mm512_permutexvar_ps(b_to, b.v);
    const __m512 low = _mm512_mask_mov_ps(_mm512_mask_mov_ps(rs, 0x2492, gs), 0x4924, bs);
    const __m512 middle = _mm512_mask_mov_ps(_mm512_mask_mov_ps(rs, 0x9249, gs), 0x2492, bs);
    const __m512 high = _mm512_mask_mov_ps(_mm512_mask_mov_ps(rs, 0x4924, gs), 0x9249, bs);
    _mm512_storeu_ps(first, low);
    _mm256_storeu_ps(first + 16, _mm512_castps512_ps256(middle));
    _mm256_storeu_ps(second, _mm512_extractf32x8_ps(middle, 1));
    _mm512_storeu_ps(second + 8, high);
}

BN_INLINE void stream_lines(float* to, const float* from, int n)
{
    for (int i = 0; i < n; i += 16)
        _mm512_stream_ps(to + i, _mm512_load_ps(from + i));
}
BN_INLINE void stream_fence()
{
    _mm_sfence();
}

BN_INLINE void load_triples_int(const std::int32_t* from, integer out[3])
{
    const __m512i a = _mm512_loadu_si512(from), b = _mm512_loadu_si512(from + 16), c = _mm512_loadu_si512(from + 32);
    const __m512i order = _mm512_setr_epi32(0, 3, 6, 9, 12, 15, 2, 5, 8, 11, 14, 1, 4, 7, 10, 13), one = _mm512_set1_epi32(1);
    const __m512i first = _mm512_mask_mov_epi32(_mm512_mask_mov_epi32(a, 0x4924, b), 0x2492, c);
    const __m512i second = _mm512_mask_mov_epi32(_mm512_mask_mov_epi32(a, 0x9249, b), 0x4924, c);
    const __m512i third = _mm512_mask_mov_epi32(_mm512_mask_mov_epi32(a, 0x2492, b), 0x9249, c);
    const __m512i order1 = _mm512_add_epi32(order, one), order2 = _mm512_add_epi32(order1, one); // their low four bits count
    out[0].v = _mm512_permutexvar_epi32(order, first);
    out[1].v = _mm512_permutexvar_epi32(order1, second);
    out[2].v = _mm512_permutexvar_epi32(order2, third);
}

#define BN_FOLD(name, op)                                                                                                                  \
    BN_INLINE real name(real x)                                                                                                            \
    {                                                                                                                                      \
        const __m256 w8 = _mm256_##op(_mm512_castps512_ps256(x.v), _mm512_extractf32x8_ps(x.v, 1));                                        \
        const __m128 w4 = _mm_##op(_mm256_castps256_ps128(w8), _mm256_extractf128_ps(w8, 1));                                              \
        const __m128 w2 = _mm_##op(w4, _mm_movehl_ps(w4, w4));                                                                             \
        const __m128 w1 = _mm_##op(w2, _mm_shuffle_ps(w2, w2, 1));                                                                         \
        return splat(_mm_cvtss_f32(w1));                                                                                                   \
    }
BN_FOLD(reduce_min, min_ps)
BN_FOLD(reduce_max, max_ps)
BN_FOLD(reduce_add, add_ps)
#undef BN_FOLD

} // namespace BN_ISA_NS
} // namespace burnish

#include "core/simd/lanes_derived.h"
#include "core/simd/records_avx512.h"
#include "core/simd/wide_avx512.h"
