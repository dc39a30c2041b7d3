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

// Adds to gradient[o][f][slot] the sum over texels of dy[o] x[f], by slots: texel i belongs to slot i mod kSlots. Blocks lie `x_block` and
// `dy_block` numbers apart.
template <int kOut, int kIn>
BN_FN void weight_gradient(const number* dy, std::size_t dy_block, const number* x, std::size_t x_block, std::size_t texels, int in,
                           number* gradient)
{
    constexpr std::size_t slots = burnish::mipnet::kSlots, lanes = static_cast<std::size_t>(kLanes);
    for (std::size_t slot = 0; slot < slots; slot += lanes) {
        real sum[kOut][kIn];
        for (int o = 0; o < kOut; ++o)
            for (int f = 0; f < kIn; ++f)
                sum[o][f] = get(gradient + static_cast<std::size_t>(o * in + f) * slots + slot);
        for (std::size_t b = 0; b < blocks_of(texels); ++b)
            for (std::size_t i = slot; i < in_block(texels, b); i += slots) {
                real seen[kIn];
                for (int f = 0; f < kIn; ++f)
                    seen[f] = get(x + b * x_block + static_cast<std::size_t>(f) * kRow + i);
                for (int o = 0; o < kOut; ++o) {
                    const real by = get(dy + b * dy_block + static_cast<std::size_t>(o) * kRow + i);
                    for (int f = 0; f < kIn; ++f)
                        sum[o][f] += by * seen[f];
                }
            }
        for (int o = 0; o < kOut; ++o)
            for (int f = 0; f < kIn; ++f)
                put(gradient + static_cast<std::size_t>(o * in + f) * slots + slot, sum[o][f]);
    }
}

template <int count> struct rows_at_once {
    static constexpr int value = count;
};

static __attribute__((noinline, unused)) void weight_gradients(const number* dy, std::size_t dy_block, const number* x, std::size_t x_block,
                                                               std::size_t texels, int in, int out, number* gradient)
{
    constexpr std::size_t slots = burnish::mipnet::kSlots;
    const auto rows = [&](int o, auto count) {
        constexpr int kOut = decltype(count)::value;
        const number* d = dy + static_cast<std::size_t>(o) * kRow;
        number* to = gradient + static_cast<std::size_t>(o * in) * slots;
        int f = 0;
        for (; f + 4 <= in; f += 4)
            weight_gradient<kOut, 4>(d, dy_block, x + static_cast<std::size_t>(f) * kRow, x_block, texels, in,
                                     to + static_cast<std::size_t>(f) * slots);
        for (; f < in; ++f)
            weight_gradient<kOut, 1>(d, dy_block, x + static_cast<std::size_t>(f) * kRow, x_block, texels, in,
                                     to + static_cast<std::size_t>(f) * slots);
    };
    int o = 0;
    for (; o + 4 <= out; o += 4)
        rows(o, rows_at_once<4>{});
    for (; o < out; ++o)
        rows(o, rows_at_once<1>{});
}

static __attribute__((noinline, unused)) void bias_gradients(const number* dy, std::size_t dy_block, std::size_t texels, int out,
                                                             number* gradient)
{
    constexpr std::size_t slots = burnish::mipnet::kSlots, lanes = static_cast<std::size_t>(kLanes);
    for (int o = 0; o < out; ++o)
        for (std::size_t slot = 0; slot < slots; slot += lanes) {
            number* to = gradient + static_cast<std::size_t>(o) * slots + slot;
            real sum = get(to);
            for (std::size_t b = 0; b < blocks_of(texels); ++b)
                for (std::size_t i = slot; i < in_block(texels, b); i += slots)
                    sum += get(dy + b * dy_block + static_cast<std::size_t>(o) * kRow + i);
            put(to, sum);
        }
}

} // namespace mipnet_lanes
BN_KERNELS_END
