// Sixteen lanes: AVX-512 F, BW, DQ, VL. Meanings: lanes_scalar.h.
// Array-of-struct data is read with 128- to 512-bit loads and transposed in registers. The transposes keep
// SIMD lane 4q + j in 128-bit part q of register j, so one vpermilps with the immediate j spreads a lane's
// weight over its part.
#pragma once
#include <cstddef>
#include <cstdint>

// GCC 12 reports the deliberately undefined operands inside its own intrinsics.
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

// minps and maxps return the second operand when either is NaN or both are zero: exactly a < b ? a : b.
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
// A double by lane, for the little that single precision cannot hold: the lower half of the lanes, then the upper.
struct wide {
    __m512d lo, hi;
};
BN_INLINE wide operator+(wide a, wide b)
{
    return {_mm512_add_pd(a.lo, b.lo), _mm512_add_pd(a.hi, b.hi)};
}
BN_INLINE wide operator-(wide a, wide b)
{
    return {_mm512_sub_pd(a.lo, b.lo), _mm512_sub_pd(a.hi, b.hi)};
}
BN_INLINE wide operator*(wide a, wide b)
{
    return {_mm512_mul_pd(a.lo, b.lo), _mm512_mul_pd(a.hi, b.hi)};
}
BN_INLINE wide operator/(wide a, wide b)
{
    return {_mm512_div_pd(a.lo, b.lo), _mm512_div_pd(a.hi, b.hi)};
}
BN_INLINE wide wide_lit(double x)
{
    return {_mm512_set1_pd(x), _mm512_set1_pd(x)};
}
BN_INLINE wide to_wide(integer i)
{
    return {_mm512_cvtepi32_pd(_mm512_castsi512_si256(i.v)), _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(i.v, 1))};
}
BN_INLINE wide to_wide(real x)
{
    return {_mm512_cvtps_pd(_mm512_castps512_ps256(x.v)), _mm512_cvtps_pd(_mm512_extractf32x8_ps(x.v, 1))};
}
BN_INLINE real to_real(wide x)
{
    return {_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(x.lo)), _mm512_cvtpd_ps(x.hi), 1)};
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
// Compressed in a register first: the compressing store is microcoded on Zen 4.
BN_INLINE int compress_store_int(std::int32_t* to, integer i, mask m)
{
    const int count = __builtin_popcount(m.v);
    _mm512_mask_storeu_epi32(to, first_lanes(count), _mm512_maskz_compress_epi32(m.v, i.v));
    return count;
}

BN_INLINE real expand_load(const float* from, mask m)
{
    return {_mm512_maskz_expand_ps(m.v, _mm512_loadu_ps(from))};
}
BN_INLINE integer expand_load_int(const std::int32_t* from, mask m)
{
    return {_mm512_maskz_expand_epi32(m.v, _mm512_loadu_si512(from))};
}
BN_INLINE void store_triples(float* first, float* second, real r, real g, real b)
{
    const __m512i r_to = _mm512_setr_epi32(0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15, 10, 5),
                  g_to = _mm512_setr_epi32(5, 0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15, 10),
                  b_to = _mm512_setr_epi32(10, 5, 0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15);
    const __m512 rs = _mm512_permutexvar_ps(r_to, r.v), gs = _mm512_permutexvar_ps(g_to, g.v),
                 bs = _mm512_permutexvar_ps(b_to, b.v);
    const __m512 low = _mm512_mask_mov_ps(_mm512_mask_mov_ps(rs, 0x2492, gs), 0x4924, bs);
    const __m512 middle = _mm512_mask_mov_ps(_mm512_mask_mov_ps(rs, 0x9249, gs), 0x2492, bs);
    const __m512 high = _mm512_mask_mov_ps(_mm512_mask_mov_ps(rs, 0x4924, gs), 0x9249, bs);
    _mm512_storeu_ps(first, low);
    _mm256_storeu_ps(first + 16, _mm512_castps512_ps256(middle));
    _mm256_storeu_ps(second, _mm512_extractf32x8_ps(middle, 1));
    _mm512_storeu_ps(second + 8, high);
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

#define BN_FOLD(name, op)                                                                                    \
    BN_INLINE real name(real x)                                                                              \
    {                                                                                                        \
        const __m256 w8 = _mm256_##op(_mm512_castps512_ps256(x.v), _mm512_extractf32x8_ps(x.v, 1));          \
        const __m128 w4 = _mm_##op(_mm256_castps256_ps128(w8), _mm256_extractf128_ps(w8, 1));                \
        const __m128 w2 = _mm_##op(w4, _mm_movehl_ps(w4, w4));                                               \
        const __m128 w1 = _mm_##op(w2, _mm_shuffle_ps(w2, w2, 1));                                           \
        return splat(_mm_cvtss_f32(w1));                                                                     \
    }
BN_FOLD(reduce_min, min_ps)
BN_FOLD(reduce_max, max_ps)
BN_FOLD(reduce_add, add_ps)
#undef BN_FOLD

// ---- array of struct
// -------------------------------------------------------------------------------------------------

struct lane_indices {
    alignas(64) std::uint32_t at[16];
};
BN_INLINE lane_indices spill(integer i)
{
    lane_indices s;
    _mm512_store_si512(s.at, i.v);
    __asm__("" : "+m"(s.at)); // keeps it in memory: GCC would extract lane by lane with shuffles
    return s;
}
// Where 64-byte records start, in units of 8 bytes: the largest that an address can scale by.
BN_INLINE lane_indices spill_records(integer index)
{
    lane_indices s;
    _mm512_store_si512(s.at, _mm512_slli_epi32(index.v, 3));
    return s;
}
BN_INLINE const float* record_at(const void* base, const lane_indices& i, int lane)
{
    return reinterpret_cast<const float*>(static_cast<const char*>(base) + std::size_t{8} * i.at[lane]);
}
// Four floats of the records of lanes j, 4 + j, 8 + j, 12 + j.
BN_INLINE __m512 quads_at(const void* base, const lane_indices& i, int j)
{
    __m512 q = _mm512_castps128_ps512(_mm_loadu_ps(record_at(base, i, j)));
    q = _mm512_insertf32x4(q, _mm_loadu_ps(record_at(base, i, j + 4)), 1);
    q = _mm512_insertf32x4(q, _mm_loadu_ps(record_at(base, i, j + 8)), 2);
    return _mm512_insertf32x4(q, _mm_loadu_ps(record_at(base, i, j + 12)), 3);
}
// r[j] holds in part q the four fields of lane 4q + j; out[f] holds field f of every lane.
BN_INLINE void transpose_quads(const __m512 r[4], real out[4])
{
    const __m512d t0 = _mm512_castps_pd(_mm512_unpacklo_ps(r[0], r[1]));
    const __m512d t1 = _mm512_castps_pd(_mm512_unpacklo_ps(r[2], r[3]));
    const __m512d t2 = _mm512_castps_pd(_mm512_unpackhi_ps(r[0], r[1]));
    const __m512d t3 = _mm512_castps_pd(_mm512_unpackhi_ps(r[2], r[3]));
    out[0].v = _mm512_castpd_ps(_mm512_unpacklo_pd(t0, t1));
    out[1].v = _mm512_castpd_ps(_mm512_unpackhi_pd(t0, t1));
    out[2].v = _mm512_castpd_ps(_mm512_unpacklo_pd(t2, t3));
    out[3].v = _mm512_castpd_ps(_mm512_unpackhi_pd(t2, t3));
}
// The weight of lane 4q + j in all of part q.
BN_INLINE __m512 lane_weight(real w, int j)
{
    switch (j) {
    case 0:
        return _mm512_permute_ps(w.v, 0x00);
    case 1:
        return _mm512_permute_ps(w.v, 0x55);
    case 2:
        return _mm512_permute_ps(w.v, 0xaa);
    default:
        return _mm512_permute_ps(w.v, 0xff);
    }
}

BN_INLINE void load_records16(const void* base, integer index, integer out[16])
{
    const lane_indices i = spill_records(index);
    for (int c = 0; c < 4; ++c) {
        const char* field = static_cast<const char*>(base) + 16 * c;
        const __m512 r[4] = {quads_at(field, i, 0), quads_at(field, i, 1), quads_at(field, i, 2),
                             quads_at(field, i, 3)};
        real f[4];
        transpose_quads(r, f);
        for (int k = 0; k < 4; ++k)
            out[4 * c + k].v = _mm512_castps_si512(f[k].v);
    }
}

BN_INLINE void store_records16(void* base, const integer r[16])
{
    for (int c = 0; c < 4; ++c) {
        __m512 in[4];
        for (int k = 0; k < 4; ++k)
            in[k] = _mm512_castsi512_ps(r[4 * c + k].v);
        real quads[4]; // [j]: part q is fields 4c to 4c + 3 of lane 4q + j
        transpose_quads(in, quads);
        for (int j = 0; j < 4; ++j) {
            float* to = static_cast<float*>(base) + 16 * j + 4 * c;
            _mm_storeu_ps(to, _mm512_castps512_ps128(quads[j].v));
            _mm_storeu_ps(to + 64, _mm512_extractf32x4_ps(quads[j].v, 1));
            _mm_storeu_ps(to + 128, _mm512_extractf32x4_ps(quads[j].v, 2));
            _mm_storeu_ps(to + 192, _mm512_extractf32x4_ps(quads[j].v, 3));
        }
    }
}
BN_INLINE void load_quads(const void* base, integer index, integer out[4])
{
    const lane_indices i = spill({_mm512_slli_epi32(index.v, 1)});
    const __m512 r[4] = {quads_at(base, i, 0), quads_at(base, i, 1), quads_at(base, i, 2), quads_at(base, i, 3)};
    real f[4];
    transpose_quads(r, f);
    for (int k = 0; k < 4; ++k)
        out[k].v = _mm512_castps_si512(f[k].v);
}
BN_INLINE void store_quads(void* base, const integer r[4], int n)
{
    __m512 in[4];
    for (int k = 0; k < 4; ++k)
        in[k] = _mm512_castsi512_ps(r[k].v);
    real q[4]; // [j]: part q is lane 4q + j
    transpose_quads(in, q);
    const __m512 ab_low = _mm512_shuffle_f32x4(q[0].v, q[1].v, 0x44), ab_high = _mm512_shuffle_f32x4(q[0].v, q[1].v, 0xee);
    const __m512 cd_low = _mm512_shuffle_f32x4(q[2].v, q[3].v, 0x44), cd_high = _mm512_shuffle_f32x4(q[2].v, q[3].v, 0xee);
    const __m512 rows[4] = {_mm512_shuffle_f32x4(ab_low, cd_low, 0x88), _mm512_shuffle_f32x4(ab_low, cd_low, 0xdd),
                            _mm512_shuffle_f32x4(ab_high, cd_high, 0x88), _mm512_shuffle_f32x4(ab_high, cd_high, 0xdd)};
    for (int j = 0; j < 4; ++j)
        _mm512_mask_storeu_ps(static_cast<float*>(base) + 16 * j, first_lanes(4 * n - 16 * j), rows[j]);
}

struct blend_lanes {
    lane_indices i0, i1, i2;
    alignas(64) float b0[16], b1[16], b2[16];
};
BN_INLINE __m512 blend_row(const float* base, const blend_lanes& s, int lane)
{
    const __m512 p0 = _mm512_mul_ps(_mm512_set1_ps(s.b0[lane]), _mm512_loadu_ps(record_at(base, s.i0, lane)));
    const __m512 p1 = _mm512_mul_ps(_mm512_set1_ps(s.b1[lane]), _mm512_loadu_ps(record_at(base, s.i1, lane)));
    const __m512 p2 = _mm512_mul_ps(_mm512_set1_ps(s.b2[lane]), _mm512_loadu_ps(record_at(base, s.i2, lane)));
    return _mm512_add_ps(_mm512_add_ps(p0, p1), p2);
}
BN_INLINE void blend_records(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2,
                             real out[16])
{
    blend_lanes s{spill_records(i0), spill_records(i1), spill_records(i2), {}, {}, {}};
    _mm512_store_ps(s.b0, b0.v);
    _mm512_store_ps(s.b1, b1.v);
    _mm512_store_ps(s.b2, b2.v);
    __m512 quads[4][4]; // [fields 4c..4c+3][j]
    for (int j = 0; j < 4; ++j) {
        const __m512 ra = blend_row(base, s, j), rb = blend_row(base, s, j + 4);
        const __m512 rc = blend_row(base, s, j + 8), rd = blend_row(base, s, j + 12);
        const __m512 ab_even = _mm512_shuffle_f32x4(ra, rb, 0x88),
                     ab_odd = _mm512_shuffle_f32x4(ra, rb, 0xdd);
        const __m512 cd_even = _mm512_shuffle_f32x4(rc, rd, 0x88),
                     cd_odd = _mm512_shuffle_f32x4(rc, rd, 0xdd);
        quads[0][j] = _mm512_shuffle_f32x4(ab_even, cd_even, 0x88);
        quads[1][j] = _mm512_shuffle_f32x4(ab_odd, cd_odd, 0x88);
        quads[2][j] = _mm512_shuffle_f32x4(ab_even, cd_even, 0xdd);
        quads[3][j] = _mm512_shuffle_f32x4(ab_odd, cd_odd, 0xdd);
    }
    for (int c = 0; c < 4; ++c)
        transpose_quads(quads[c], out + 4 * c);
}
BN_INLINE void blend_quad(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2,
                          real out[4])
{
    const lane_indices s0 = spill_records(i0), s1 = spill_records(i1), s2 = spill_records(i2);
    __m512 r[4];
    for (int j = 0; j < 4; ++j) {
        const __m512 p0 = _mm512_mul_ps(lane_weight(b0, j), quads_at(base, s0, j));
        const __m512 p1 = _mm512_mul_ps(lane_weight(b1, j), quads_at(base, s1, j));
        const __m512 p2 = _mm512_mul_ps(lane_weight(b2, j), quads_at(base, s2, j));
        r[j] = _mm512_add_ps(_mm512_add_ps(p0, p1), p2);
    }
    transpose_quads(r, out);
}
BN_INLINE void blend_records_low(const float* base, integer i0, integer i1, integer i2, real b0, real b1,
                                 real b2, real out[8])
{
    blend_quad(base, i0, i1, i2, b0, b1, b2, out);
    blend_quad(base + 4, i0, i1, i2, b0, b1, b2, out + 4);
}

// Two lanes share a register, [left a, right a, left b, right b]: at[j] holds lanes j and 4 + j, at[4 + j] 8
// + j and 12 + j.
using texel_buffer = const std::uint16_t*;
struct texel_acc {
    __m512 at[8];
};
BN_INLINE texel_acc texel_zero()
{
    const __m512 z = _mm512_setzero_ps();
    return {{z, z, z, z, z, z, z, z}};
}
BN_INLINE __m512 texel_pairs(texel_buffer texels, const lane_indices& i, int a, int b)
{
    const __m128i pair_a =
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(texels + std::size_t{4} * i.at[a]));
    const __m128i pair_b =
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(texels + std::size_t{4} * i.at[b]));
    return _mm512_cvtph_ps(_mm256_inserti128_si256(_mm256_castsi128_si256(pair_a), pair_b, 1));
}
// [left 0-3, right 0-3, left 4-7, right 4-7] of lanes first to first + 7.
BN_INLINE real texel_weights(real left, real right, int first)
{
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
    const __m512i high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    return {_mm512_castpd_ps(
        _mm512_permutex2var_pd(_mm512_castps_pd(left.v), first ? high : low, _mm512_castps_pd(right.v)))};
}
struct texel_plan {
    lane_indices row0, row1;
    real w00, w10, w01, w11;
};
BN_INLINE void plan_texels(texel_plan& p, integer row0, integer row1, real w00, real w10, real w01, real w11)
{
    _mm512_store_si512(p.row0.at, row0.v);
    _mm512_store_si512(p.row1.at, row1.v);
    p.w00 = w00, p.w10 = w10, p.w01 = w01, p.w11 = w11;
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, const texel_plan& p)
{
    for (int half = 0; half < 2; ++half) {
        const real w0 = texel_weights(p.w00, p.w10, 8 * half), w1 = texel_weights(p.w01, p.w11, 8 * half);
        for (int j = 0; j < 4; ++j) {
            const int a = 8 * half + j;
            const __m512 p0 = _mm512_mul_ps(lane_weight(w0, j), texel_pairs(texels, p.row0, a, a + 4));
            const __m512 p1 = _mm512_mul_ps(lane_weight(w1, j), texel_pairs(texels, p.row1, a, a + 4));
            acc.at[4 * half + j] = _mm512_add_ps(acc.at[4 * half + j], _mm512_add_ps(p0, p1));
        }
    }
    return acc;
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, integer row0, integer row1, real w00,
                              real w10, real w01, real w11)
{
    return texel_add(acc, texels, {spill(row0), spill(row1), w00, w10, w01, w11});
}
BN_INLINE void texel_values(texel_acc acc, real out[4])
{
    __m512 r[4];
    for (int j = 0; j < 4; ++j) {
        const __m512 left = _mm512_shuffle_f32x4(acc.at[j], acc.at[4 + j], 0x88);
        const __m512 right = _mm512_shuffle_f32x4(acc.at[j], acc.at[4 + j], 0xdd);
        r[j] = _mm512_add_ps(left, right);
    }
    transpose_quads(r, out);
}

} // namespace BN_ISA_NS
} // namespace burnish

#include "core/simd/lanes_derived.h"
