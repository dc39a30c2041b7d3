// Arrays of structs, pairs of table values and texels by WebAssembly's own instructions, for lanes_portable.h. Four words of a record are
// read at once, then transposed into lanes.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

BN_INLINE const char* record_at(const void* base, const integer& index, int lane, std::size_t bytes)
{
    return static_cast<const char*>(base) + bytes * static_cast<std::uint32_t>(index.p[lane / 4][lane % 4]);
}
// Transposes four rows of four words.
BN_INLINE void turn_words(const v128_t row[4], v128_t out[4])
{
    const v128_t ab_low = wasm_i32x4_shuffle(row[0], row[1], 0, 4, 1, 5), ab_high = wasm_i32x4_shuffle(row[0], row[1], 2, 6, 3, 7);
    const v128_t cd_low = wasm_i32x4_shuffle(row[2], row[3], 0, 4, 1, 5), cd_high = wasm_i32x4_shuffle(row[2], row[3], 2, 6, 3, 7);
    out[0] = wasm_i64x2_shuffle(ab_low, cd_low, 0, 2), out[1] = wasm_i64x2_shuffle(ab_low, cd_low, 1, 3);
    out[2] = wasm_i64x2_shuffle(ab_high, cd_high, 0, 2), out[3] = wasm_i64x2_shuffle(ab_high, cd_high, 1, 3);
}
template <int kWords> BN_INLINE void load_words(const void* base, const integer& index, integer* out)
{
    for (int p = 0; p < kParts; ++p)
        for (int f = 0; f < kWords; f += 4) {
            v128_t row[4], turned[4];
            for (int k = 0; k < 4; ++k)
                row[k] = wasm_v128_load(record_at(base, index, 4 * p + k, 4 * kWords) + 4 * f);
            turn_words(row, turned);
            for (int k = 0; k < 4; ++k)
                out[f + k].p[p] = ints_of(turned[k]);
        }
}
template <int kWords> BN_INLINE void store_words(void* base, const integer* r, int n)
{
    for (int p = 0; p < kParts; ++p)
        for (int f = 0; f < kWords; f += 4) {
            v128_t row[4], turned[4];
            for (int k = 0; k < 4; ++k)
                row[k] = v128_of(r[f + k].p[p]);
            turn_words(row, turned);
            for (int k = 0; k < 4 && 4 * p + k < n; ++k)
                wasm_v128_store(static_cast<char*>(base) + 4 * kWords * (4 * p + k) + 4 * f, turned[k]);
        }
}
BN_INLINE void load_records16(const void* base, const integer& index, integer out[16])
{
    load_words<16>(base, index, out);
}
BN_INLINE void store_records16(void* base, const integer r[16])
{
    store_words<16>(base, r, kLanes);
}
BN_INLINE void load_quads(const void* base, const integer& index, integer out[4])
{
    load_words<4>(base, index, out);
}
BN_INLINE void store_quads(void* base, const integer r[4], int n)
{
    store_words<4>(base, r, n);
}

template <int kFields>
BN_CALL void blend_fields(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                          const real& b2, real* out)
{
    for (int p = 0; p < kParts; ++p)
        for (int f = 0; f < kFields; f += 4) {
            v128_t row[4], turned[4];
            for (int k = 0; k < 4; ++k) {
                const auto term = [&](const integer& i, const real& b) {
                    return wasm_f32x4_mul(wasm_f32x4_splat(b.p[p][k]), wasm_v128_load(record_at(base + f, i, 4 * p + k, 64)));
                };
                row[k] = wasm_f32x4_add(wasm_f32x4_add(term(i0, b0), term(i1, b1)), term(i2, b2));
            }
            turn_words(row, turned);
            for (int k = 0; k < 4; ++k)
                out[f + k].p[p] = floats_of(turned[k]);
        }
}
BN_INLINE void blend_records(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                             const real& b2, real out[16])
{
    blend_fields<16>(base, i0, i1, i2, b0, b1, b2, out);
}
BN_INLINE void blend_records_low(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                                 const real& b2, real out[8])
{
    blend_fields<8>(base, i0, i1, i2, b0, b1, b2, out);
}
BN_INLINE void blend_quad(const float* base, const integer& i0, const integer& i1, const integer& i2, const real& b0, const real& b1,
                          const real& b2, real out[4])
{
    blend_fields<4>(base, i0, i1, i2, b0, b1, b2, out);
}

using pair_table = const float*;
BN_INLINE void load_pairs(pair_table table, const integer& index, real out[4])
{
    for (int p = 0; p < kParts; ++p) {
        v128_t row[4], turned[4];
        for (int k = 0; k < 4; ++k)
            row[k] = wasm_v128_load(record_at(table, index, 4 * p + k, 8));
        turn_words(row, turned);
        for (int k = 0; k < 4; ++k)
            out[k].p[p] = floats_of(turned[k]);
    }
}

// Converts four halves, sign-extended to words: a product with 2^112 changes the exponent's bias. Exact for zeros and normal halves.
// Processors take long for products of subnormal floats, and Inf has no product.
BN_INLINE v128_t rebiased(v128_t word)
{
    const v128_t shifted = wasm_i32x4_shl(word, 13) & wasm_i32x4_splat(static_cast<int>(0x8fffe000u));
    return wasm_f32x4_mul(shifted, wasm_f32x4_splat(0x1p112f));
}
// Returns true where one of the halves is subnormal, Inf or NaN.
BN_INLINE bool any_special(v128_t a, v128_t b)
{
    const v128_t magnitudes = wasm_i16x8_splat(0x7fff), one = wasm_i16x8_splat(1);
    const v128_t m = a & magnitudes, n = b & magnitudes;
    const v128_t least = wasm_u16x8_min(wasm_i16x8_sub(m, one), wasm_i16x8_sub(n, one)); // zeros become the largest
    const v128_t most = wasm_i16x8_max(m, n);
    return wasm_v128_any_true(wasm_u16x8_sub_sat(wasm_i16x8_splat(0x3ff), least) | wasm_u16x8_sub_sat(most, wasm_i16x8_splat(0x7bff)));
}
struct half_pair {
    v128_t low, high; // four floats each
};
BN_INLINE half_pair special_floats(v128_t halves)
{
    const auto converted = [](v128_t word) {
        const v128_t magnitude = word & wasm_i32x4_splat(0x7fff), shifted = wasm_i32x4_shl(magnitude, 13);
        const v128_t normal = wasm_i32x4_add(shifted, wasm_i32x4_splat(112 << 23));
        const v128_t beyond = wasm_i32x4_gt(magnitude, wasm_i32x4_splat(0x7bff)) & wasm_i32x4_splat(112 << 23);
        const v128_t nan = wasm_i32x4_gt(magnitude, wasm_i32x4_splat(0x7c00)) & wasm_i32x4_splat(1 << 22); // quiet
        const v128_t subnormal = wasm_f32x4_sub(wasm_i32x4_add(shifted, wasm_i32x4_splat(113 << 23)), wasm_f32x4_splat(0x1p-14f));
        const v128_t small = wasm_i32x4_lt(magnitude, wasm_i32x4_splat(0x400));
        const v128_t positive = wasm_v128_bitselect(subnormal, wasm_i32x4_add(normal, beyond) | nan, small);
        return positive | wasm_i32x4_shl(word & wasm_i32x4_splat(0x8000), 16);
    };
    return {converted(wasm_u32x4_extend_low_u16x8(halves)), converted(wasm_u32x4_extend_high_u16x8(halves))};
}
BN_INLINE half_pair normal_floats(v128_t halves)
{
    return {rebiased(wasm_i32x4_extend_low_i16x8(halves)), rebiased(wasm_i32x4_extend_high_i16x8(halves))};
}

using texel_buffer = const std::uint16_t*;
// A sum by lane: four channels in a register.
struct texel_acc {
    v128_t left[kLanes], right[kLanes];
};
BN_INLINE texel_acc texel_zero()
{
    return texel_acc{};
}
BN_INLINE void load_texel_pair(texel_buffer texels, std::uint32_t at, float out[8])
{
    const v128_t pair = wasm_v128_load(texels + std::size_t{4} * at);
    const half_pair floats = any_special(pair, pair) ? special_floats(pair) : normal_floats(pair);
    wasm_v128_store(out, floats.low);
    wasm_v128_store(out + 4, floats.high);
}
BN_CALL void add_texels(texel_acc& acc, texel_buffer texels, const integer& row0, const integer& row1, const real& w00, const real& w10,
                        const real& w01, const real& w11)
{
    for (int p = 0; p < kParts; ++p)
        for (int k = 0; k < 4; ++k) {
            const int lane = 4 * p + k;
            const v128_t above = wasm_v128_load(record_at(texels, row0, lane, 8)), below = wasm_v128_load(record_at(texels, row1, lane, 8));
            half_pair x, y;
            if (__builtin_expect(any_special(above, below), 0))
                x = special_floats(above), y = special_floats(below);
            else
                x = normal_floats(above), y = normal_floats(below);
            const auto sum = [&](const real& a, v128_t of_a, const real& b, v128_t of_b) {
                return wasm_f32x4_add(wasm_f32x4_mul(wasm_f32x4_splat(a.p[p][k]), of_a), wasm_f32x4_mul(wasm_f32x4_splat(b.p[p][k]), of_b));
            };
            acc.left[lane] = wasm_f32x4_add(acc.left[lane], sum(w00, x.low, w01, y.low));
            acc.right[lane] = wasm_f32x4_add(acc.right[lane], sum(w10, x.high, w11, y.high));
        }
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, const integer& row0, const integer& row1, const real& w00,
                              const real& w10, const real& w01, const real& w11)
{
    add_texels(acc, texels, row0, row1, w00, w10, w01, w11);
    return acc;
}
struct texel_plan {
    integer row0, row1;
    real w00, w10, w01, w11;
};
BN_INLINE void plan_texels(texel_plan& p, const integer& row0, const integer& row1, const real& w00, const real& w10, const real& w01,
                           const real& w11)
{
    p = {row0, row1, w00, w10, w01, w11};
}
BN_INLINE texel_acc texel_add(texel_acc acc, texel_buffer texels, const texel_plan& p)
{
    return texel_add(acc, texels, p.row0, p.row1, p.w00, p.w10, p.w01, p.w11);
}
BN_INLINE void texel_values(const texel_acc& acc, real out[4])
{
    for (int p = 0; p < kParts; ++p) {
        v128_t row[4], turned[4];
        for (int k = 0; k < 4; ++k)
            row[k] = wasm_f32x4_add(acc.left[4 * p + k], acc.right[4 * p + k]);
        turn_words(row, turned);
        for (int k = 0; k < 4; ++k)
            out[k].p[p] = floats_of(turned[k]);
    }
}

} // namespace BN_ISA_NS
} // namespace burnish
