// The forward pass of a net over a level's texels: what a texel sees, layers, and the outputs on closed forms. Kernels of mipnet.isa.cpp
// and of training share it.
#pragma once
#include "shading/bake/mipnet/cascade.h"
#include "shading/bake/mipnet/dense.h"
#include "shading/bake/mipnet/mipnet_fns.h"

BN_KERNELS_BEGIN
namespace mipnet_lanes {

namespace net = burnish::mipnet;
using net::Dense, net::Plan;

inline constexpr std::size_t kLane = static_cast<std::size_t>(kLanes), kPlanes = net::kChannels;

// Bump allocator in cache lines. Without memory it only counts.
struct Pool {
    char* at;
    std::size_t used = 0;
    template <class T> T* take(std::size_t count)
    {
        T* const found = at ? reinterpret_cast<T*>(at + used) : nullptr;
        used += (count * sizeof(T) + 63) / 64 * 64;
        return found;
    }
};

struct NetMemory { // rows of each layer's outputs, block by block; layer 0: the features
    number* layer[net::kMostLayers + 1];
};
static inline __attribute__((unused)) NetMemory net_memory(Pool& pool, const Dense& d, std::size_t blocks)
{
    NetMemory m = {};
    for (int l = 0; l <= d.count; ++l)
        m.layer[l] = pool.take<number>(blocks * static_cast<std::size_t>(d.width[l]) * kRow);
    return m;
}
BN_FN std::size_t block_size(const Dense& d, int layer)
{
    return static_cast<std::size_t>(d.width[layer]) * kRow;
}

// Inputs for a level's texels: planes with finer levels and with net `a`'s results. `first` is null while net `a` itself runs.
struct Sources {
    const number *children, *grandchildren, *great, *first;
    std::size_t n;
    bool far; // there are sixty-four; they repeat the sixteen if `great` is null
    bool all() const { return first != nullptr; }
};

// Gathers the texels that a net sees for texel i.
template <class V, class Make> BN_FN seen_texels<V> gathered(const Sources& s, std::size_t i, const V& kappa0, const V& kappa1, Make make)
{
    const auto read = [&](const number* planes, std::size_t per_plane, std::size_t at) {
        const V nx = make(get(planes + at)), ny = make(get(planes + per_plane + at)), a = make(get(planes + 2 * per_plane + at)),
                b = make(get(planes + 3 * per_plane + at)), c = make(get(planes + 4 * per_plane + at));
        return texel<V>{nx, ny, a, b, c};
    };
    seen_texels<V> seen = {};
    seen.all = s.all(), seen.far = seen.all && s.far, seen.kappa0 = kappa0, seen.kappa1 = kappa1;
    for (std::size_t j = 0; j < 4; ++j)
        seen.four[j] = read(s.children, 4 * s.n, j * s.n + i);
    if (seen.all) {
        for (std::size_t j = 0; j < 16; ++j)
            seen.sixteen[j] = read(s.grandchildren, 16 * s.n, j * s.n + i);
        for (std::size_t j = 0; seen.far && j < 64; ++j)
            seen.sixtyfour[j] = s.great ? read(s.great, 64 * s.n, j * s.n + i) : seen.sixteen[j % 16];
        seen.first = read(s.first, s.n, i);
    }
    return seen;
}

template <class V> BN_FN closed_form<V> look(net::Layout layout, const seen_texels<V>& seen, V* features)
{
    return layout == net::Layout::cov ? look_cov(seen, features) : look_paper(seen, features);
}
template <class V, class W> BN_FN auto settle(net::Layout layout, const closed_form<V>& c, const W* o)
{
    return layout == net::Layout::cov ? settle_cov(c, o) : settle_paper(c, o);
}

static __attribute__((noinline, unused)) closed_form<real> look_here(const Plan& plan, const number* weights, const Sources& s,
                                                                     std::size_t i, real* features)
{
    const real k0 = all_lanes(weights[plan.kappa]), k1 = all_lanes(weights[plan.kappa + 1]);
    return look(plan.layout, gathered<real>(s, i, k0, k1, [](real v) { return v; }), features);
}

// Computes the texels in block `block`. Activations go to the memory's block `kept`.
static __attribute__((unused)) void forward_block(const Plan& plan, const number* weights, const Dense& d, const Sources& s,
                                                  std::size_t block, std::size_t kept, const NetMemory& m, number* out)
{
    // Compute features
    const std::size_t begin = block * kBlock, count = in_block(s.n, block);
    closed_form<real> closed[kBlock / kLane];
    number* const features = m.layer[0] + kept * block_size(d, 0);
    for (std::size_t i = 0; i < count; i += kLane) {
        real f[kMostFeatures];
        closed[i / kLane] = look_here(plan, weights, s, begin + i, f);
        for (int k = 0; k < d.width[0]; ++k)
            put(features + static_cast<std::size_t>(k) * kRow + i, f[k]);
    }
    // Run the layers
    for (int l = 0; l < d.count; ++l) {
        const number *w = weights + d.weights[l], *bias = weights + d.bias[l], *x = m.layer[l] + kept * block_size(d, l);
        number* const y = m.layer[l + 1] + kept * block_size(d, l + 1);
        if (l + 1 < d.count)
            dense<After::leak>(w, bias, x, d.width[l], d.width[l + 1], count, y);
        else
            dense<After::nothing>(w, bias, x, d.width[l], d.width[l + 1], count, y);
    }
    // Apply the outputs to the closed forms
    const number* const outputs = m.layer[d.count] + kept * block_size(d, d.count);
    for (std::size_t i = 0; i < count; i += kLane) {
        real o[kPlanes];
        for (std::size_t k = 0; k < kPlanes; ++k)
            o[k] = get(outputs + k * kRow + i);
        real channels[kPlanes];
        channels_of(settle(plan.layout, closed[i / kLane], o), channels);
        for (std::size_t k = 0; k < kPlanes; ++k)
            put(out + k * s.n + begin + i, channels[k]);
    }
}

} // namespace mipnet_lanes
BN_KERNELS_END
