// Eight lanes: AVX2 and F16C. Meanings: lanes_scalar.h. No fma anywhere. A mask is all ones or all zeros in
// each lane. Array-of-struct data is read with 128-bit loads and transposed in registers. The transposes keep
// SIMD lane 4q + j in 128-bit part q of register j, so one vpermilps with the immediate j spreads a lane's
// weight over its part.
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
    return {
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), lane_bit), lane_bit)};
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

// minps and maxps return the second operand when either is NaN or both are zero: exactly a < b ? a : b.
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
// A double by lane, for the little that single precision cannot hold: the lower half of the lanes, then the upper.
struct wide {
    __m256d lo, hi;
};
BN_INLINE wide operator+(wide a, wide b)
{
    return {_mm256_add_pd(a.lo, b.lo), _mm256_add_pd(a.hi, b.hi)};
}
BN_INLINE wide operator-(wide a, wide b)
{
    return {_mm256_sub_pd(a.lo, b.lo), _mm256_sub_pd(a.hi, b.hi)};
}
BN_INLINE wide operator*(wide a, wide b)
{
    return {_mm256_mul_pd(a.lo, b.lo), _mm256_mul_pd(a.hi, b.hi)};
}
BN_INLINE wide operator/(wide a, wide b)
{
    return {_mm256_div_pd(a.lo, b.lo), _mm256_div_pd(a.hi, b.hi)};
}
BN_INLINE wide wide_lit(double x)
{
    return {_mm256_set1_pd(x), _mm256_set1_pd(x)};
}
BN_INLINE wide to_wide(integer i)
{
    return {_mm256_cvtepi32_pd(_mm256_castsi256_si128(i.v)), _mm256_cvtepi32_pd(_mm256_extracti128_si256(i.v, 1))};
}
BN_INLINE wide to_wide(real x)
{
    return {_mm256_cvtps_pd(_mm256_castps256_ps128(x.v)), _mm256_cvtps_pd(_mm256_extractf128_ps(x.v, 1))};
}
BN_INLINE real to_real(wide x)
{
    return {_mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(x.lo)), _mm256_cvtpd_ps(x.hi), 1)};
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
BN_INLINE real table_value(const float* table, integer index)
{
    return gather(table, index);
}
BN_INLINE integer table_int(const std::int32_t* table, integer index)
{
    return gather_int(table, index);
}
BN_INLINE int compress_store_int(std::int32_t* to, integer i, mask m)
{
    const std::uint32_t bits = to_bits(m);
    const std::uint64_t bytes = _pdep_u64(bits, 0x0101010101010101u) * 0xff;
    const std::uint64_t from = _pext_u64(0x0706050403020100u, bytes);
    const __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(from)));
    const int count = __builtin_popcount(bits);
    _mm256_maskstore_epi32(to, first_lanes(count), _mm256_permutevar8x32_epi32(i.v, order));
    return count;
}

BN_INLINE __m256i expand_load_words(const void* from, mask m)
{
    const std::uint64_t bytes = _pdep_u64(to_bits(m), 0x0101010101010101u) * 0xff;
    const __m256i order =
        _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(_pdep_u64(0x0706050403020100u, bytes))));
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
BN_INLINE void store_triples(float* first, float*, real r, real g, real b)
{
    // each register of the result takes every third word of each channel
    const __m256i r_to = _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5), g_to = _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2),
                  b_to = _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7);
    const __m256 rs = _mm256_permutevar8x32_ps(r.v, r_to), gs = _mm256_permutevar8x32_ps(g.v, g_to),
                 bs = _mm256_permutevar8x32_ps(b.v, b_to);
    _mm256_storeu_ps(first, _mm256_blend_ps(_mm256_blend_ps(rs, gs, 0x92), bs, 0x24));
    _mm256_storeu_ps(first + 8, _mm256_blend_ps(_mm256_blend_ps(rs, gs, 0x24), bs, 0x49));
    _mm256_storeu_ps(first + 16, _mm256_blend_ps(_mm256_blend_ps(rs, gs, 0x49), bs, 0x92));
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

#define BN_FOLD(name, op)                                                                                    \
    BN_INLINE real name(real x)                                                                              \
    {                                                                                                        \
        const __m128 w4 = _mm_##op(_mm256_castps256_ps128(x.v), _mm256_extractf128_ps(x.v, 1));              \
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
    alignas(32) std::uint32_t at[8];
};
BN_INLINE lane_indices spill(integer i)
{
    lane_indices s;
    _mm256_store_si256(reinterpret_cast<__m256i*>(s.at), i.v);
    __asm__("" : "+m"(s.at)); // keeps it in memory: GCC would extract lane by lane with shuffles
    return s;
}
// Where 64-byte records start, in units of 8 bytes: the largest that an address can scale by.
BN_INLINE lane_indices spill_records(integer index)
{
    lane_indices s;
    _mm256_store_si256(reinterpret_cast<__m256i*>(s.at), _mm256_slli_epi32(index.v, 3));
    return s;
}
BN_INLINE const float* record_at(const void* base, const lane_indices& i, int lane)
{
    return reinterpret_cast<const float*>(static_cast<const char*>(base) + std::size_t{8} * i.at[lane]);
}
// Four floats of the records of lanes j and 4 + j.
BN_INLINE __m256 quads_at(const void* base, const lane_indices& i, int j)
{
    const __m256 q = _mm256_castps128_ps256(_mm_loadu_ps(record_at(base, i, j)));
    return _mm256_insertf128_ps(q, _mm_loadu_ps(record_at(base, i, j + 4)), 1);
}
// r[j] holds in part q the four fields of lane 4q + j; out[f] holds field f of every lane.
BN_INLINE void transpose_quads(const __m256 r[4], real out[4])
{
    const __m256d t0 = _mm256_castps_pd(_mm256_unpacklo_ps(r[0], r[1]));
    const __m256d t1 = _mm256_castps_pd(_mm256_unpacklo_ps(r[2], r[3]));
    const __m256d t2 = _mm256_castps_pd(_mm256_unpackhi_ps(r[0], r[1]));
    const __m256d t3 = _mm256_castps_pd(_mm256_unpackhi_ps(r[2], r[3]));
    out[0].v = _mm256_castpd_ps(_mm256_unpacklo_pd(t0, t1));
    out[1].v = _mm256_castpd_ps(_mm256_unpackhi_pd(t0, t1));
    out[2].v = _mm256_castpd_ps(_mm256_unpacklo_pd(t2, t3));
    out[3].v = _mm256_castpd_ps(_mm256_unpackhi_pd(t2, t3));
}
// The weight of lane 4q + j in all of part q.
BN_INLINE __m256 lane_weight(__m256 w, int j)
{
    switch (j) {
    case 0:
        return _mm256_permute_ps(w, 0x00);
    case 1:
        return _mm256_permute_ps(w, 0x55);
    case 2:
        return _mm256_permute_ps(w, 0xaa);
    default:
        return _mm256_permute_ps(w, 0xff);
    }
}

BN_INLINE void load_records16(const void* base, integer index, integer out[16])
{
    const lane_indices i = spill_records(index);
    for (int c = 0; c < 4; ++c) {
        const char* field = static_cast<const char*>(base) + 16 * c;
        const __m256 r[4] = {quads_at(field, i, 0), quads_at(field, i, 1), quads_at(field, i, 2),
                             quads_at(field, i, 3)};
        real f[4];
        transpose_quads(r, f);
        for (int k = 0; k < 4; ++k)
            out[4 * c + k].v = _mm256_castps_si256(f[k].v);
    }
}

BN_INLINE void store_records16(void* base, const integer r[16])
{
    for (int c = 0; c < 4; ++c) {
        __m256 in[4];
        for (int k = 0; k < 4; ++k)
            in[k] = _mm256_castsi256_ps(r[4 * c + k].v);
        real quads[4]; // [j]: part q is fields 4c to 4c + 3 of lane 4q + j
        transpose_quads(in, quads);
        for (int j = 0; j < 4; ++j) {
            float* to = static_cast<float*>(base) + 16 * j + 4 * c;
            _mm_storeu_ps(to, _mm256_castps256_ps128(quads[j].v));
            _mm_storeu_ps(to + 64, _mm256_extractf128_ps(quads[j].v, 1));
        }
    }
}
BN_INLINE void load_quads(const void* base, integer index, integer out[4])
{
    const lane_indices i = spill({_mm256_slli_epi32(index.v, 1)});
    const __m256 r[4] = {quads_at(base, i, 0), quads_at(base, i, 1), quads_at(base, i, 2), quads_at(base, i, 3)};
    real f[4];
    transpose_quads(r, f);
    for (int k = 0; k < 4; ++k)
        out[k].v = _mm256_castps_si256(f[k].v);
}
BN_INLINE void store_quads(void* base, const integer r[4], int n)
{
    __m256 in[4];
    for (int k = 0; k < 4; ++k)
        in[k] = _mm256_castsi256_ps(r[k].v);
    real q[4]; // [j]: part q is lane 4q + j
    transpose_quads(in, q);
    const __m256 rows[4] = {_mm256_permute2f128_ps(q[0].v, q[1].v, 0x20), _mm256_permute2f128_ps(q[2].v, q[3].v, 0x20),
                            _mm256_permute2f128_ps(q[0].v, q[1].v, 0x31), _mm256_permute2f128_ps(q[2].v, q[3].v, 0x31)};
    for (int j = 0; j < 4; ++j)
        _mm256_maskstore_ps(static_cast<float*>(base) + 8 * j, first_lanes(4 * n - 8 * j), rows[j]);
}

BN_INLINE void blend_fields(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2,
                            real* out, int fields)
{
    const lane_indices s0 = spill_records(i0), s1 = spill_records(i1), s2 = spill_records(i2);
    for (int c = 0; c < fields; c += 4) {
        __m256 r[4];
        for (int j = 0; j < 4; ++j) {
            const __m256 p0 = _mm256_mul_ps(lane_weight(b0.v, j), quads_at(base + c, s0, j));
            const __m256 p1 = _mm256_mul_ps(lane_weight(b1.v, j), quads_at(base + c, s1, j));
            const __m256 p2 = _mm256_mul_ps(lane_weight(b2.v, j), quads_at(base + c, s2, j));
            r[j] = _mm256_add_ps(_mm256_add_ps(p0, p1), p2);
        }
        transpose_quads(r, out + c);
    }
}
BN_INLINE void blend_records(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2,
                             real out[16])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 16);
}
BN_INLINE void blend_records_low(const float* base, integer i0, integer i1, integer i2, real b0, real b1,
                                 real b2, real out[8])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 8);
}
BN_INLINE void blend_quad(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2,
                          real out[4])
{
    blend_fields(base, i0, i1, i2, b0, b1, b2, out, 4);
}

// One register a lane: [left texel, right texel].
using texel_buffer = const std::uint16_t*;
struct texel_acc {
    __m256 at[8];
};
BN_INLINE texel_acc texel_zero()
{
    const __m256 z = _mm256_setzero_ps();
    return {{z, z, z, z, z, z, z, z}};
}
BN_INLINE __m256 texel_pair(texel_buffer texels, const lane_indices& i, int lane)
{
    return _mm256_cvtph_ps(
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(texels + std::size_t{4} * i.at[lane])));
}
struct texel_plan {
    lane_indices row0, row1;
    real w00, w10, w01, w11;
};
BN_INLINE void plan_texels(texel_plan& p, integer row0, integer row1, real w00, real w10, real w01, real w11)
{
    _mm256_store_si256(reinterpret_cast<__m256i*>(p.row0.at), row0.v);
    _mm256_store_si256(reinterpret_cast<__m256i*>(p.row1.at), row1.v);
    p.w00 = w00, p.w10 = w10, p.w01 = w01, p.w11 = w11;
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, const texel_plan& p)
{
    for (int half = 0; half < 2; ++half) { // weights: [left of four lanes, right of the same]
        const __m256 w0 =
            half ? _mm256_permute2f128_ps(p.w00.v, p.w10.v, 0x31) : _mm256_permute2f128_ps(p.w00.v, p.w10.v, 0x20);
        const __m256 w1 =
            half ? _mm256_permute2f128_ps(p.w01.v, p.w11.v, 0x31) : _mm256_permute2f128_ps(p.w01.v, p.w11.v, 0x20);
        for (int j = 0; j < 4; ++j) {
            const int lane = 4 * half + j;
            const __m256 p0 = _mm256_mul_ps(lane_weight(w0, j), texel_pair(texels, p.row0, lane));
            const __m256 p1 = _mm256_mul_ps(lane_weight(w1, j), texel_pair(texels, p.row1, lane));
            acc.at[lane] = _mm256_add_ps(acc.at[lane], _mm256_add_ps(p0, p1));
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
    __m256 r[4];
    for (int j = 0; j < 4; ++j) {
        const __m256 left = _mm256_permute2f128_ps(acc.at[j], acc.at[4 + j], 0x20);
        const __m256 right = _mm256_permute2f128_ps(acc.at[j], acc.at[4 + j], 0x31);
        r[j] = _mm256_add_ps(left, right);
    }
    transpose_quads(r, out);
}

} // namespace BN_ISA_NS
} // namespace burnish

#include "core/simd/lanes_derived.h"
