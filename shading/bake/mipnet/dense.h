// Dense layers over texel blocks: rows of kRow numbers, whose first kBlock belong to a block's texels.
#pragma once
#include "shading/bake/mipnet/autodiff.h"
#include "shading/bake/mipnet/mipnet_fns.h"

BN_KERNELS_BEGIN
namespace mipnet_lanes {

inline constexpr std::size_t kBlock = 64, kRow = 80; // 16 more, so that rows do not collide in a cache's sets

BN_FN std::size_t blocks_of(std::size_t texels)
{
    return (texels + kBlock - 1) / kBlock;
}
BN_FN std::size_t in_block(std::size_t texels, std::size_t block) // number of texels in a block
{
    const std::size_t left = texels - block * kBlock;
    return left < kBlock ? left : kBlock;
}

enum class After { nothing, leak };

// Computes kOut rows of y = W x + bias for kVectors texel vectors.
template <int kOut, int kVectors, After after>
BN_FN void dense_rows(const number* w, const number* bias, const number* x, int in, number* y)
{
    real sum[kOut][kVectors];
    for (int o = 0; o < kOut; ++o)
        for (int v = 0; v < kVectors; ++v)
            sum[o][v] = bias ? all_lanes(bias[o]) : lit(0.0);
    for (int f = 0; f < in; ++f) {
        real seen[kVectors];
        for (int v = 0; v < kVectors; ++v)
            seen[v] = get(x + static_cast<std::size_t>(f) * kRow + static_cast<std::size_t>(v * kLanes));
        for (int o = 0; o < kOut; ++o) {
            const real by = all_lanes(w[o * in + f]);
            for (int v = 0; v < kVectors; ++v)
                sum[o][v] += by * seen[v];
        }
    }
    for (int o = 0; o < kOut; ++o)
        for (int v = 0; v < kVectors; ++v) {
            real r = sum[o][v];
            if (after == After::leak)
                r = max(r, r * lit(static_cast<double>(burnish::mipnet::kLeak)));
            put(y + static_cast<std::size_t>(o) * kRow + static_cast<std::size_t>(v * kLanes), r);
        }
}

template <int kVectors, After after>
BN_FN void dense_columns(const number* w, const number* bias, const number* x, int in, int out, number* y)
{
    int o = 0;
    for (; o + 4 <= out; o += 4)
        dense_rows<4, kVectors, after>(w + o * in, bias ? bias + o : nullptr, x, in, y + static_cast<std::size_t>(o) * kRow);
    for (; o < out; ++o)
        dense_rows<1, kVectors, after>(w + o * in, bias ? bias + o : nullptr, x, in, y + static_cast<std::size_t>(o) * kRow);
}

// Applies a layer to the first `texels` of a block. w: [out][in]; bias: null for none.
template <After after>
static __attribute__((noinline, unused)) void dense(const number* w, const number* bias, const number* x, int in, int out,
                                                    std::size_t texels, number* y)
{
    constexpr std::size_t lanes = static_cast<std::size_t>(kLanes);
    std::size_t i = 0;
    for (; i + 2 * lanes <= texels; i += 2 * lanes)
        dense_columns<2, after>(w, bias, x + i, in, out, y + i);
    for (; i < texels; i += lanes)
        dense_columns<1, after>(w, bias, x + i, in, out, y + i);
}

} // namespace mipnet_lanes
BN_KERNELS_END
