// Records, quads and texels in eight lanes (part of lanes_avx2.h). 128-bit loads read struct arrays, and registers
// transpose them. The transposes put SIMD lane 4q + j into register j's 128-bit part q. Then one vpermilps with
// immediate j spreads a lane's weight over the part.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

struct lane_indices {
    alignas(32) std::uint32_t at[8];
};
BN_INLINE lane_indices spill(integer i)
{
    lane_indices s;
    _mm256_store_si256(reinterpret_cast<__m256i*>(s.at), i.v);
    __asm__("" : "+m"(s.at)); // keeps the indices in memory: GCC would extract them one by one with shuffles
    return s;
}
// Returns the starts of 64-byte records in 8-byte units, the largest scale in an address.
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
// Loads four floats from the records for lanes j and 4 + j.
BN_INLINE __m256 quads_at(const void* base, const lane_indices& i, int j)
{
    const __m256 q = _mm256_castps128_ps256(_mm_loadu_ps(record_at(base, i, j)));
    return _mm256_insertf128_ps(q, _mm_loadu_ps(record_at(base, i, j + 4)), 1);
}
// Transposes. Part q in r[j] holds the four fields for lane 4q + j; out[f] holds every lane's field f.
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
// Spreads the weight for lane 4q + j over part q.
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
        const __m256 r[4] = {quads_at(field, i, 0), quads_at(field, i, 1), quads_at(field, i, 2), quads_at(field, i, 3)};
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
        real quads[4]; // [j]: part q holds fields 4c to 4c + 3 of lane 4q + j
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
using pair_table = const float*;
BN_INLINE void load_pairs(pair_table table, integer index, real out[4])
{
    const lane_indices i = spill(index);
    const __m256 r[4] = {quads_at(table, i, 0), quads_at(table, i, 1), quads_at(table, i, 2), quads_at(table, i, 3)};
    transpose_quads(r, out);
}
BN_INLINE void store_quads(void* base, const integer r[4], int n)
{
    __m256 in[4];
    for (int k = 0; k < 4; ++k)
        in[k] = _mm256_castsi256_ps(r[k].v);
    real q[4]; // [j]: part q holds lane 4q + j
    transpose_quads(in, q);
    const __m256 rows[4] = {_mm256_permute2f128_ps(q[0].v, q[1].v, 0x20), _mm256_permute2f128_ps(q[2].v, q[3].v, 0x20),
                            _mm256_permute2f128_ps(q[0].v, q[1].v, 0x31), _mm256_permute2f128_ps(q[2].v, q[3].v, 0x31)};
    float* const to = static_cast<float*>(base);
    for (int j = 0; j < 4; ++j)
        if (n == kLanes) // masked stores are microcoded on Zen
            _mm256_storeu_ps(to + 8 * j, rows[j]);
        else
            _mm256_maskstore_ps(to + 8 * j, first_lanes(4 * n - 8 * j), rows[j]);
}

template <int kPart>
BN_INLINE __m256 blend_part(const float* base, const lane_indices& s0, const lane_indices& s1, const lane_indices& s2, real b0, real b1,
                            real b2)
{
    const __m256 p0 = _mm256_mul_ps(lane_weight(b0.v, kPart), quads_at(base, s0, kPart));
    const __m256 p1 = _mm256_mul_ps(lane_weight(b1.v, kPart), quads_at(base, s1, kPart));
    const __m256 p2 = _mm256_mul_ps(lane_weight(b2.v, kPart), quads_at(base, s2, kPart));
    return _mm256_add_ps(_mm256_add_ps(p0, p1), p2);
}
BN_INLINE void blend_four(const float* base, const lane_indices& s0, const lane_indices& s1, const lane_indices& s2, real b0, real b1,
                          real b2, real out[4])
{
    const __m256 r[4] = {blend_part<0>(base, s0, s1, s2, b0, b1, b2), blend_part<1>(base, s0, s1, s2, b0, b1, b2),
                         blend_part<2>(base, s0, s1, s2, b0, b1, b2), blend_part<3>(base, s0, s1, s2, b0, b1, b2)};
    transpose_quads(r, out);
}
BN_INLINE void blend_records(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[16])
{
    const lane_indices s0 = spill_records(i0), s1 = spill_records(i1), s2 = spill_records(i2);
    blend_four(base, s0, s1, s2, b0, b1, b2, out);
    blend_four(base + 4, s0, s1, s2, b0, b1, b2, out + 4);
    blend_four(base + 8, s0, s1, s2, b0, b1, b2, out + 8);
    blend_four(base + 12, s0, s1, s2, b0, b1, b2, out + 12);
}
BN_INLINE void blend_records_low(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[8])
{
    const lane_indices s0 = spill_records(i0), s1 = spill_records(i1), s2 = spill_records(i2);
    blend_four(base, s0, s1, s2, b0, b1, b2, out);
    blend_four(base + 4, s0, s1, s2, b0, b1, b2, out + 4);
}
BN_INLINE void blend_quad(const float* base, integer i0, integer i1, integer i2, real b0, real b1, real b2, real out[4])
{
    blend_four(base, spill_records(i0), spill_records(i1), spill_records(i2), b0, b1, b2, out);
}

// One register for each lane: [left texel, right texel].
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
    return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(texels + std::size_t{4} * i.at[lane])));
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
    _mm256_store_si256(reinterpret_cast<__m256i*>(p.row0.at), row0.v);
    _mm256_store_si256(reinterpret_cast<__m256i*>(p.row1.at), row1.v);
    p.w00 = w00, p.w10 = w10, p.w01 = w01, p.w11 = w11;
}
// Adds one lane's texels. w0, w1: weights for the upper and lower row, [left of four lanes, right of the same lanes].
template <int kLane> BN_INLINE void texel_add_lane(texel_acc& acc, texel_buffer texels, const texel_plan& p, __m256 w0, __m256 w1)
{
    const __m256 p0 = _mm256_mul_ps(lane_weight(w0, kLane & 3), texel_pair(texels, p.row0, kLane));
    const __m256 p1 = _mm256_mul_ps(lane_weight(w1, kLane & 3), texel_pair(texels, p.row1, kLane));
    __m256 sum = _mm256_add_ps(p0, p1);
    __asm__("" : "+x"(sum)); // forces the sum now: GCC would delay it and keep its operands in memory
    acc.at[kLane] = _mm256_add_ps(acc.at[kLane], sum);
}
// No loop, so that the compiler keeps several sums in registers.
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, const texel_plan& p)
{
    const __m256 low0 = _mm256_permute2f128_ps(p.w00.v, p.w10.v, 0x20), low1 = _mm256_permute2f128_ps(p.w01.v, p.w11.v, 0x20);
    texel_add_lane<0>(acc, texels, p, low0, low1);
    texel_add_lane<1>(acc, texels, p, low0, low1);
    texel_add_lane<2>(acc, texels, p, low0, low1);
    texel_add_lane<3>(acc, texels, p, low0, low1);
    const __m256 high0 = _mm256_permute2f128_ps(p.w00.v, p.w10.v, 0x31), high1 = _mm256_permute2f128_ps(p.w01.v, p.w11.v, 0x31);
    texel_add_lane<4>(acc, texels, p, high0, high1);
    texel_add_lane<5>(acc, texels, p, high0, high1);
    texel_add_lane<6>(acc, texels, p, high0, high1);
    texel_add_lane<7>(acc, texels, p, high0, high1);
    return acc;
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, integer row0, integer row1, real w00, real w10, real w01, real w11)
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
