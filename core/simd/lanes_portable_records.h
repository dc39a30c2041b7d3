// Arrays of structs, pairs of table values and texels, for lanes_portable.h.
#pragma once

namespace burnish {
inline namespace BN_ISA_NS {

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

} // namespace BN_ISA_NS
} // namespace burnish
