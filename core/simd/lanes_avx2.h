// Eight lanes: AVX2 and F16C, without fma. lanes_scalar.h defines the operations. A mask holds all ones or all zeros in
// each lane.
#pragma once
#include <cstddef>
#include <cstdint>
#include <immintrin.h>

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr int kLanes = 8;

struct real {
    __m256 v;
};
struct integer {
    __m256i v;
};
struct mask {
    __m256i v;
};

BN_INLINE real splat(float x)
{
    return {_mm256_set1_ps(x)};
}
BN_INLINE real lit(double x)
{
    return {_mm256_set1_ps(static_cast<float>(x))};
}
BN_INLINE integer int_lit(int x)
{
    return {_mm256_set1_epi32(x)};
}
BN_INLINE integer iota()
{
    return {_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)};
}
BN_INLINE __m256i ones()
{
    return _mm256_set1_epi32(-1);
}

BN_INLINE real operator+(real a, real b)
{
    return {_mm256_add_ps(a.v, b.v)};
}
BN_INLINE real operator-(real a, real b)
{
    return {_mm256_sub_ps(a.v, b.v)};
}
BN_INLINE real operator*(real a, real b)
{
    return {_mm256_mul_ps(a.v, b.v)};
}
BN_INLINE real operator/(real a, real b)
{
    return {_mm256_div_ps(a.v, b.v)};
}
BN_INLINE real operator-(real a)
{
    return {_mm256_xor_ps(a.v, _mm256_set1_ps(-0.0f))};
}
BN_INLINE mask operator<(real a, real b)
{
    return {_mm256_castps_si256(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ))};
}
BN_INLINE mask operator<=(real a, real b)
{
    return {_mm256_castps_si256(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ))};
}
BN_INLINE mask operator>(real a, real b)
{
    return {_mm256_castps_si256(_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ))};
}
BN_INLINE mask operator>=(real a, real b)
{
    return {_mm256_castps_si256(_mm256_cmp_ps(a.v, b.v, _CMP_GE_OQ))};
}
BN_INLINE mask operator==(real a, real b)
{
    return {_mm256_castps_si256(_mm256_cmp_ps(a.v, b.v, _CMP_EQ_OQ))};
}
BN_INLINE mask operator!=(real a, real b)
{
    return {_mm256_castps_si256(_mm256_cmp_ps(a.v, b.v, _CMP_NEQ_UQ))};
}

BN_INLINE integer operator+(integer a, integer b)
{
    return {_mm256_add_epi32(a.v, b.v)};
}
BN_INLINE integer operator-(integer a, integer b)
{
    return {_mm256_sub_epi32(a.v, b.v)};
}
BN_INLINE integer operator*(integer a, integer b)
{
    return {_mm256_mullo_epi32(a.v, b.v)};
}
BN_INLINE integer operator-(integer a)
{
    return {_mm256_sub_epi32(_mm256_setzero_si256(), a.v)};
}
BN_INLINE integer operator&(integer a, integer b)
{
    return {_mm256_and_si256(a.v, b.v)};
}
BN_INLINE integer operator|(integer a, integer b)
{
    return {_mm256_or_si256(a.v, b.v)};
}
BN_INLINE integer operator^(integer a, integer b)
{
    return {_mm256_xor_si256(a.v, b.v)};
}
BN_INLINE integer operator~(integer a)
{
    return {_mm256_xor_si256(a.v, ones())};
}
BN_INLINE mask operator<(integer a, integer b)
{
    return {_mm256_cmpgt_epi32(b.v, a.v)};
}
BN_INLINE mask operator>(integer a, integer b)
{
    return {_mm256_cmpgt_epi32(a.v, b.v)};
}
BN_INLINE mask operator<=(integer a, integer b)
{
    return {_mm256_xor_si256(_mm256_cmpgt_epi32(a.v, b.v), ones())};
}
BN_INLINE mask operator>=(integer a, integer b)
{
    return {_mm256_xor_si256(_mm256_cmpgt_epi32(b.v, a.v), ones())};
}
BN_INLINE mask operator==(integer a, integer b)
{
    return {_mm256_cmpeq_epi32(a.v, b.v)};
}
BN_INLINE mask operator!=(integer a, integer b)
{
    return {_mm256_xor_si256(_mm256_cmpeq_epi32(a.v, b.v), ones())};
}
BN_INLINE integer shl(integer i, int n)
{
    return {_mm256_slli_epi32(i.v, n)};
}
BN_INLINE integer shr(integer i, int n)
{
    return {_mm256_srai_epi32(i.v, n)};
}
BN_INLINE integer shr_logical(integer i, int n)
{
    return {_mm256_srli_epi32(i.v, n)};
}
BN_INLINE integer count_bits4(integer i)
{
    const __m128i bits = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4); // the lanes' upper bytes are 0
    return {_mm256_shuffle_epi8(_mm256_broadcastsi128_si256(bits), i.v)};
}

BN_INLINE mask both(mask a, mask b)
{
    return {_mm256_and_si256(a.v, b.v)};
}
BN_INLINE mask either(mask a, mask b)
{
    return {_mm256_or_si256(a.v, b.v)};
}
BN_INLINE mask not_(mask a)
{
    return {_mm256_xor_si256(a.v, ones())};
}
BN_INLINE bool any(mask m)
{
    return _mm256_testz_si256(m.v, m.v) == 0;
}
BN_INLINE bool none(mask m)
{
    return _mm256_testz_si256(m.v, m.v) != 0;
}
BN_INLINE bool all(mask m)
{
    return _mm256_testc_si256(m.v, ones()) != 0;
}
BN_INLINE std::uint32_t to_bits(mask m)
{
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(m.v)));
}
BN_INLINE mask mask_from_bits(std::uint32_t bits)
{
    const __m256i lane_bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return {_mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), lane_bit), lane_bit)};
}

BN_INLINE real select(mask m, real a, real b)
{
    return {_mm256_blendv_ps(b.v, a.v, _mm256_castsi256_ps(m.v))};
}
BN_INLINE integer select(mask m, integer a, integer b)
{
    return {_mm256_blendv_epi8(b.v, a.v, m.v)};
}
BN_INLINE mask select(mask m, mask a, mask b)
{
    return {_mm256_blendv_epi8(b.v, a.v, m.v)};
}

// minps and maxps return the second operand where either is NaN or both are zero: exactly a < b ? a : b.
BN_INLINE real min(real a, real b)
{
    return {_mm256_min_ps(a.v, b.v)};
}
BN_INLINE real max(real a, real b)
{
    return {_mm256_max_ps(a.v, b.v)};
}
BN_INLINE integer min(integer a, integer b)
{
    return {_mm256_min_epi32(a.v, b.v)};
}
BN_INLINE integer max(integer a, integer b)
{
    return {_mm256_max_epi32(a.v, b.v)};
}
BN_INLINE real abs(real x)
{
    return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), x.v)};
}
BN_INLINE real sqrt(real x)
{
    return {_mm256_sqrt_ps(x.v)};
}
BN_INLINE real floor(real x)
{
    return {_mm256_floor_ps(x.v)};
}
BN_INLINE real ceil(real x)
{
    return {_mm256_ceil_ps(x.v)};
}

BN_INLINE real to_real(integer i)
{
    return {_mm256_cvtepi32_ps(i.v)};
}
BN_INLINE integer to_int(real x)
{
    return {_mm256_cvttps_epi32(x.v)};
}
BN_INLINE integer round_to_int(real x)
{
    return {_mm256_cvtps_epi32(x.v)};
}
BN_INLINE integer bits_of(real x)
{
    return {_mm256_castps_si256(x.v)};
}
BN_INLINE real real_from_bits(integer i)
{
    return {_mm256_castsi256_ps(i.v)};
}

BN_INLINE __m256i first_lanes(int n)
{
    return _mm256_cmpgt_epi32(_mm256_set1_epi32(n), iota().v);
}
BN_INLINE __m256i load_words(const void* from)
{
    return _mm256_loadu_si256(static_cast<const __m256i*>(from));
}

BN_INLINE real load(const float* from)
{
    return {_mm256_loadu_ps(from)};
}
BN_INLINE void store(float* to, real x)
{
    _mm256_storeu_ps(to, x.v);
}
BN_INLINE integer load_int(const std::int32_t* from)
{
    return {load_words(from)};
}
BN_INLINE integer load_int(const std::uint32_t* from)
{
    return {load_words(from)};
}
BN_INLINE void store_int(std::int32_t* to, integer i)
{
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), i.v);
}
BN_INLINE void store_int(std::uint32_t* to, integer i)
{
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), i.v);
}
BN_INLINE real load_first(const float* from, int n)
{
    return {_mm256_maskload_ps(from, first_lanes(n))};
}
BN_INLINE integer load_first(const std::int32_t* from, int n)
{
    return {_mm256_maskload_epi32(from, first_lanes(n))};
}
BN_INLINE void store_first(float* to, real x, int n)
{
    _mm256_maskstore_ps(to, first_lanes(n), x.v);
}
BN_INLINE void store_first(std::int32_t* to, integer i, int n)
{
    _mm256_maskstore_epi32(to, first_lanes(n), i.v);
}
BN_INLINE real gather(const float* base, integer index)
{
    return {_mm256_i32gather_ps(base, index.v, 4)};
}
BN_INLINE integer gather_int(const std::int32_t* base, integer index)
{
    return {_mm256_i32gather_epi32(base, index.v, 4)};
}
// Keeps both table halves in registers, because a gather is slow.
BN_INLINE integer table_int(const std::int32_t* table, integer index)
{
    const __m256i lower = _mm256_permutevar8x32_epi32(load_words(table), index.v);
    const __m256i upper = _mm256_permutevar8x32_epi32(load_words(table + 8), index.v);
    return {_mm256_blendv_epi8(lower, upper, _mm256_cmpgt_epi32(index.v, _mm256_set1_epi32(7)))};
}
BN_INLINE real table_value(const float* table, integer index)
{
    return {_mm256_castsi256_ps(table_int(reinterpret_cast<const std::int32_t*>(table), index).v)};
}
BN_INLINE int compress_store_int(std::int32_t* to, integer i, mask m)
{
    const std::uint32_t bits = to_bits(m);
    const std::uint64_t bytes = _pdep_u64(bits, 0x0101010101010101u) * 0xff;
    const std::uint64_t from = _pext_u64(0x0706050403020100u, bytes);
    const __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(from)));
    // write the whole register: masked stores are microcoded on Zen, and loads wait for them
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(i.v, order));
    return __builtin_popcount(bits);
}

BN_INLINE __m256i expand_load_words(const void* from, mask m)
{
    const std::uint64_t bytes = _pdep_u64(to_bits(m), 0x0101010101010101u) * 0xff;
    const __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(_pdep_u64(0x0706050403020100u, bytes))));
    const __m256i words = _mm256_loadu_si256(static_cast<const __m256i*>(from));
    return _mm256_and_si256(_mm256_permutevar8x32_epi32(words, order), m.v);
}
BN_INLINE real expand_load(const float* from, mask m)
{
    return {_mm256_castsi256_ps(expand_load_words(from, m))};
}
BN_INLINE integer expand_load_int(const std::int32_t* from, mask m)
{
    return {expand_load_words(from, m)};
}
BN_INLINE real load_rows(const float* first, const float*)
{
    return load(first);
}
BN_INLINE void store_rows(float* first, float*, real x)
{
    store(first, x);
}
BN_INLINE void store_triples(float* first, float*, real r, real g, real b)
{
    // each result register takes every third word of each channel
    const __m256i r_to = _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5), g_to = _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2),
                  b_to = _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7);
    const __m256 rs = _mm256_permutevar8x32_ps(r.v, r_to), gs = _mm256_permutevar8x32_ps(g.v, g_to),
                 bs = _mm256_permutevar8x32_ps(b.v, b_to);
    _mm256_storeu_ps(first, _mm256_blend_ps(_mm256_blend_ps(rs, gs, 0x92), bs, 0x24));
    _mm256_storeu_ps(first + 8, _mm256_blend_ps(_mm256_blend_ps(rs, gs, 0x24), bs, 0x49));
    _mm256_storeu_ps(first + 16, _mm256_blend_ps(_mm256_blend_ps(rs, gs, 0x49), bs, 0x92));
}

BN_INLINE void stream_lines(float* to, const float* from, int n)
{
    for (int i = 0; i < n; i += 8)
        _mm256_stream_ps(to + i, _mm256_load_ps(from + i));
}
BN_INLINE void stream_fence()
{
    _mm_sfence();
}

BN_INLINE void load_triples_int(const std::int32_t* from, integer out[3])
{
    const __m256i* words = reinterpret_cast<const __m256i*>(from);
    const __m256i a = _mm256_loadu_si256(words), b = _mm256_loadu_si256(words + 1), c = _mm256_loadu_si256(words + 2);
    const __m256i order = _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5), one = _mm256_set1_epi32(1);
    const __m256i first = _mm256_blend_epi32(_mm256_blend_epi32(a, b, 0x92), c, 0x24);
    const __m256i second = _mm256_blend_epi32(_mm256_blend_epi32(a, b, 0x24), c, 0x49);
    const __m256i third = _mm256_blend_epi32(_mm256_blend_epi32(a, b, 0x49), c, 0x92);
    const __m256i order1 = _mm256_add_epi32(order, one), order2 = _mm256_add_epi32(order1, one); // their low three bits count
    out[0].v = _mm256_permutevar8x32_epi32(first, order);
    out[1].v = _mm256_permutevar8x32_epi32(second, order1);
    out[2].v = _mm256_permutevar8x32_epi32(third, order2);
}

#define BN_FOLD(name, op)                                                                                                                  \
    BN_INLINE real name(real x)                                                                                                            \
    {                                                                                                                                      \
        const __m128 w4 = _mm_##op(_mm256_castps256_ps128(x.v), _mm256_extractf128_ps(x.v, 1));                                            \
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
#include "core/simd/records_avx2.h"
#include "core/simd/wide_avx2.h"
