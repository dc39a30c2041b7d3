// Gradients of dense layers by their weights.
#pragma once
#include "shading/bake/mipnet/dense.h"

BN_KERNELS_BEGIN
namespace mipnet_lanes {

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
