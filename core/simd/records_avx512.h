// Records, quads and texels in sixteen lanes (part of lanes_avx512.h). 128-bit to 512-bit loads read struct arrays,
// and registers transpose them. The transposes put SIMD lane 4q + j into register j's 128-bit part q. Then one
// vpermilps with immediate j spreads a lane's weight over the part.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

struct lane_indices {
    alignas(64) std::uint32_t at[16];
};
BN_INLINE lane_indices spill(integer i)
{
    lane_indices s;
    _mm512_store_si512(s.at, i.v);
    __asm__("" : "+m"(s.at)); // keeps the indices in memory: GCC would extract them one by one with shuffles
    return s;
}
// Returns the starts of 64-byte records in 8-byte units, the largest scale in an address.
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
// Loads four floats from the records for lanes j, 4 + j, 8 + j, 12 + j.
BN_INLINE __m512 quads_at(const void* base, const lane_indices& i, int j)
{
    __m512 q = _mm512_castps128_ps512(_mm_loadu_ps(record_at(base, i, j)));
    q = _mm512_insertf32x4(q, _mm_loadu_ps(record_at(base, i, j + 4)), 1);
    q = _mm512_insertf32x4(q, _mm_loadu_ps(record_at(base, i, j + 8)), 2);
    return _mm512_insertf32x4(q, _mm_loadu_ps(record_at(base, i, j + 12)), 3);
}
// Transposes. Part q in r[j] holds the four fields for lane 4q + j; out[f] holds every lane's field f.
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
// Spreads the weight for lane 4q + j over part q.
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
        const __m512 r[4] = {quads_at(field, i, 0), quads_at(field, i, 1), quads_at(field, i, 2), quads_at(field, i, 3)};
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
        real quads[4]; // [j]: part q holds fields 4c to 4c + 3 of lane 4q + j
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
using pair_table = const float*;
BN_INLINE void load_pairs(pair_table table, integer index, real out[4])
{
    const lane_indices i = spill(index);
    const __m512 r[4] = {quads_at(table, i, 0), quads_at(table, i, 1), quads_at(table, i, 2), quads_at(table, i, 3)};
    transpose_quads(r, out);
}
BN_INLINE void store_quads(void* base, const integer r[4], int n)
{
    __m512 in[4];
    for (int k = 0; k < 4; ++k)
        in[k] = _mm512_castsi512_ps(r[k].v);
    real q[4]; // [j]: part q holds lane 4q + j
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
BN_INLINE void blend_records(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[16])
{
    blend_lanes s{spill_records(i0), spill_records(i1), spill_records(i2), {}, {}, {}};
    _mm512_store_ps(s.b0, b0.v);
    _mm512_store_ps(s.b1, b1.v);
    _mm512_store_ps(s.b2, b2.v);
    __m512 quads[4][4]; // [fields 4c..4c+3][j]
    for (int j = 0; j < 4; ++j) {
        const __m512 ra = blend_row(base, s, j), rb = blend_row(base, s, j + 4);
        const __m512 rc = blend_row(base, s, j + 8), rd = blend_row(base, s, j + 12);
        const __m512 ab_even = _mm512_shuffle_f32x4(ra, rb, 0x88), ab_odd = _mm512_shuffle_f32x4(ra, rb, 0xdd);
        const __m512 cd_even = _mm512_shuffle_f32x4(rc, rd, 0x88), cd_odd = _mm512_shuffle_f32x4(rc, rd, 0xdd);
        quads[0][j] = _mm512_shuffle_f32x4(ab_even, cd_even, 0x88);
        quads[1][j] = _mm512_shuffle_f32x4(ab_odd, cd_odd, 0x88);
        quads[2][j] = _mm512_shuffle_f32x4(ab_even, cd_even, 0xdd);
        quads[3][j] = _mm512_shuffle_f32x4(ab_odd, cd_odd, 0xdd);
    }
    for (int c = 0; c < 4; ++c)
        transpose_quads(quads[c], out + 4 * c);
}
BN_INLINE void blend_quad(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[4])
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
BN_INLINE void blend_records_low(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[8])
{
    blend_quad(base, i0, i1, i2, b0, b1, b2, out);
    blend_quad(base + 4, i0, i1, i2, b0, b1, b2, out + 4);
}

// Two lanes share a register, [left a, right a, left b, right b]: at[j] holds lanes j and 4 + j, at[4 + j] holds lanes
// 8 + j and 12 + j.
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
    const __m128i pair_a = _mm_loadu_si128(reinterpret_cast<const __m128i*>(texels + std::size_t{4} * i.at[a]));
    const __m128i pair_b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(texels + std::size_t{4} * i.at[b]));
    return _mm512_cvtph_ps(_mm256_inserti128_si256(_mm256_castsi128_si256(pair_a), pair_b, 1));
}
// Returns [left 0-3, right 0-3, left 4-7, right 4-7] for lanes first to first + 7.
BN_INLINE real texel_weights(real left, real right, int first)
{
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
    const __m512i high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    return {_mm512_castpd_ps(_mm512_permutex2var_pd(_mm512_castps_pd(left.v), first ? high : low, _mm512_castps_pd(right.v)))};
}
BN_INLINE void load_texel_pair(texel_buffer texels, std::uint32_t at, float out[8])
{
    _mm256_storeu_ps(out, _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(texels + std::size_t{4} * at))));
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
// Adds the texels for lanes kLane and kLane + 4. w0, w1: texel_weights() for the upper and lower row.
template <int kLane> BN_INLINE void texel_add_lanes(texel_acc& acc, texel_buffer texels, const texel_plan& p, real w0, real w1)
{
    constexpr int kAt = kLane < 8 ? kLane : kLane - 4;
    const __m512 p0 = _mm512_mul_ps(lane_weight(w0, kLane & 3), texel_pairs(texels, p.row0, kLane, kLane + 4));
    const __m512 p1 = _mm512_mul_ps(lane_weight(w1, kLane & 3), texel_pairs(texels, p.row1, kLane, kLane + 4));
    __m512 sum = _mm512_add_ps(p0, p1);
    __asm__("" : "+v"(sum)); // forces the sum now: GCC would delay it and keep its operands in memory
    acc.at[kAt] = _mm512_add_ps(acc.at[kAt], sum);
}
// No loop, so that the compiler keeps several sums in registers.
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, const texel_plan& p)
{
    const real low0 = texel_weights(p.w00, p.w10, 0), low1 = texel_weights(p.w01, p.w11, 0);
    texel_add_lanes<0>(acc, texels, p, low0, low1);
    texel_add_lanes<1>(acc, texels, p, low0, low1);
    texel_add_lanes<2>(acc, texels, p, low0, low1);
    texel_add_lanes<3>(acc, texels, p, low0, low1);
    const real high0 = texel_weights(p.w00, p.w10, 8), high1 = texel_weights(p.w01, p.w11, 8);
    texel_add_lanes<8>(acc, texels, p, high0, high1);
    texel_add_lanes<9>(acc, texels, p, high0, high1);
    texel_add_lanes<10>(acc, texels, p, high0, high1);
    texel_add_lanes<11>(acc, texels, p, high0, high1);
    return acc;
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, integer row0, integer row1, real w00, real w10, real w01, real w11)
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
