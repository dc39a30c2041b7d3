#include "shading/bake/mipnet/mipnet_fns.h"

#include "shading/bake/mipnet/cascade.h"
#include "shading/bake/mipnet/dense.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace mipnet_lanes {
namespace {

namespace net = burnish::mipnet;
using net::Dense, net::Plan;

constexpr std::size_t kLane = static_cast<std::size_t>(kLanes), kSlotCount = net::kSlots, kVectorsOfSlots = kSlotCount / kLane;
constexpr std::size_t kPlanes = net::kChannels;

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
NetMemory net_memory(Pool& pool, const Dense& d, std::size_t blocks)
{
    NetMemory m = {};
    for (int l = 0; l <= d.count; ++l)
        m.layer[l] = pool.take<number>(blocks * static_cast<std::size_t>(d.width[l]) * kRow);
    return m;
}
std::size_t block_size(const Dense& d, int layer)
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

__attribute__((noinline)) closed_form<real> look_here(const Plan& plan, const number* weights, const Sources& s, std::size_t i,
                                                      real* features)
{
    const real k0 = all_lanes(weights[plan.kappa]), k1 = all_lanes(weights[plan.kappa + 1]);
    return look(plan.layout, gathered<real>(s, i, k0, k1, [](real v) { return v; }), features);
}

// Computes the texels in block `block`. Activations go to the memory's block `kept`.
void forward_block(const Plan& plan, const number* weights, const Dense& d, const Sources& s, std::size_t block, std::size_t kept,
                   const NetMemory& m, number* out)
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

struct ForwardMemory {
    NetMemory a, b;
    number* first;
};
ForwardMemory forward_memory(Pool& pool, const Plan& plan, std::size_t texels)
{
    ForwardMemory m = {};
    m.a = net_memory(pool, plan.a, 1), m.b = net_memory(pool, plan.b, 1);
    m.first = pool.take<number>(kPlanes * texels);
    return m;
}
std::size_t forward_bytes(const Plan& plan, std::size_t texels)
{
    Pool pool = {nullptr};
    forward_memory(pool, plan, texels);
    return pool.used;
}

void forward(const net::ForwardWork& work)
{
    const Plan& plan = *work.plan;
    Pool pool = {static_cast<char*>(work.memory)};
    const ForwardMemory m = forward_memory(pool, plan, work.texels);
    const auto* weights = static_cast<const number*>(work.weights);
    auto* out = static_cast<number*>(work.out);
    const bool all = work.grandchildren != nullptr && plan.b.count > 0;
    Sources s = {static_cast<const number*>(work.children),
                 static_cast<const number*>(work.grandchildren),
                 static_cast<const number*>(work.great),
                 nullptr,
                 work.texels,
                 plan.far};
    for (std::size_t block = 0; block < blocks_of(s.n); ++block) {
        s.first = nullptr;
        forward_block(plan, weights, plan.a, s, block, 0, m.a, all ? m.first : out);
        s.first = m.first;
        if (all)
            forward_block(plan, weights, plan.b, s, block, 0, m.b, out);
    }
}

// Training: all memory of one shard.
struct Level {
    std::size_t n;
    number *x, *adjoint, *first, *first_adjoint; // planes
    NetMemory a, b;
};
struct StepMemory {
    Level level[net::kTrainedLevels + 1];
    number* truth[net::kTrainedLevels + 1]; // radiance by pair and texel; level 0 holds one pair
    number *ping, *pong;                    // adjoints of activations
    light* lights;                          // by pair and vector of slots
    tape on;
};
StepMemory step_memory(Pool& pool, const Plan& plan, int pair_count)
{
    StepMemory m = {};
    const std::size_t pairs = static_cast<std::size_t>(pair_count);
    std::size_t n = kSlotCount * net::kTileSide * net::kTileSide;
    for (int k = 0; k <= net::kTrainedLevels; ++k, n /= 4) {
        Level& level = m.level[k];
        level.n = n;
        m.truth[k] = pool.take<number>(k == 0 ? n : pairs * n);
        if (k == 0)
            continue;
        level.x = pool.take<number>(kPlanes * n), level.adjoint = pool.take<number>(kPlanes * n);
        level.a = net_memory(pool, plan.a, blocks_of(n));
        if (k >= 2 && plan.b.count > 0) {
            level.first = pool.take<number>(kPlanes * n), level.first_adjoint = pool.take<number>(kPlanes * n);
            level.b = net_memory(pool, plan.b, blocks_of(n));
        }
    }
    std::size_t widest = 0;
    const Dense* const nets[] = {&plan.a, &plan.b};
    for (const Dense* d : nets)
        for (int l = 0; l <= d->count; ++l)
            widest = block_size(*d, l) > widest ? block_size(*d, l) : widest;
    m.ping = pool.take<number>(blocks_of(m.level[1].n) * widest), m.pong = pool.take<number>(blocks_of(m.level[1].n) * widest);
    m.lights = pool.take<light>(pairs * kVectorsOfSlots);
    m.on = {pool.take<tape_node>(kTapeLength), pool.take<real>(kTapeLength), pool.take<real>(kTapeLength), 0};
    return m;
}
std::size_t step_bytes(const Plan& plan, int pair_count)
{
    Pool pool = {nullptr};
    step_memory(pool, plan, pair_count);
    return pool.used;
}

template <int lobe> void make_lights(const net::StepWork& work, StepMemory& m)
{
    const auto *pairs = static_cast<const number*>(work.pairs), *tiles = static_cast<const number*>(work.tiles);
    for (std::size_t p = 0; p < static_cast<std::size_t>(work.pair_count); ++p)
        for (std::size_t v = 0; v < kVectorsOfSlots; ++v) {
            const number *d = pairs + p * 6 * kSlotCount + v * kLane, *t = tiles + v * kLane;
            const auto at = [](const number* from, std::size_t k) { return get(from + k * kSlotCount); };
            m.lights[p * kVectorsOfSlots + v] =
                light_of<lobe>(vec3_of(at(d, 0), at(d, 1), at(d, 2)), vec3_of(at(d, 3), at(d, 4), at(d, 5)), at(t, 0), at(t, 1), at(t, 2));
        }
}

// Averages the light that level 0 reflects over the texels of each level: linear, as a distant camera gathers it.
template <int lobe> __attribute__((noinline)) void make_truth(const net::StepWork& work, StepMemory& m)
{
    for (std::size_t p = 0; p < static_cast<std::size_t>(work.pair_count); ++p) {
        const auto lit_level = [&](const void* planes, std::size_t n, number* to) {
            const auto* x = static_cast<const number*>(planes);
            for (std::size_t i = 0; i < n; i += kLane) {
                const texel<real> t = {get(x + i), get(x + n + i), get(x + 2 * n + i), get(x + 3 * n + i), get(x + 4 * n + i)};
                put(to + i, radiance<lobe>(lobe_place_of(t), m.lights[p * kVectorsOfSlots + i / kLane % kVectorsOfSlots]));
            }
        };
        // With a teacher, light its levels
        for (int k = 1; work.taught && k <= net::kTrainedLevels; ++k)
            lit_level(work.taught[k - 1], m.level[k].n, m.truth[k] + p * m.level[k].n);
        if (work.taught)
            continue;
        // Otherwise light level 0, and average down
        lit_level(work.texels, m.level[0].n, m.truth[0]);
        const number* below = m.truth[0];
        for (int k = 1; k <= net::kTrainedLevels; ++k) {
            const std::size_t n = m.level[k].n;
            number* const to = m.truth[k] + p * n;
            for (std::size_t i = 0; i < n; i += kLane)
                put(to + i, (get(below + i) + get(below + n + i) + get(below + 2 * n + i) + get(below + 3 * n + i)) * lit(0.25));
            below = to;
        }
    }
}

struct penalty {
    real value, slope;
};
BN_FN penalty penalty_of(net::Loss kind, real e)
{
    if (kind == net::Loss::l2)
        return {e * e, e + e};
    if (kind == net::Loss::charbonnier) {
        const real root = sqrt(e * e + lit(1e-4));
        return {root, e / root};
    }
    return {max(e, -e), select(e > lit(0.0), lit(1.0), select(e < lit(0.0), lit(-1.0), lit(0.0)))};
}
BN_FN tone_pair shown_as(net::Tone kind, real x)
{
    return kind == net::Tone::log ? tone_pair{log1p_of(x), lit(1.0) / (x + lit(1.0))} : tone(x);
}

// Computes the mean penalty of tonemapped radiance, and its gradient by the level's texels.
template <int lobe> __attribute__((noinline)) void make_loss(const net::StepWork& work, StepMemory& m, int k)
{
    Level& level = m.level[k];
    const std::size_t n = level.n, pairs = static_cast<std::size_t>(work.pair_count);
    const real share = lit(work.level_weight[k - 1] / (static_cast<double>(n) * static_cast<double>(pairs)));
    const real zero = lit(0.0), one = lit(1.0);
    number* const loss = static_cast<number*>(work.loss) + static_cast<std::size_t>(k - 1) * kSlotCount;
    real found[kVectorsOfSlots], wanted[kVectorsOfSlots];
    for (std::size_t slot = 0; slot < kVectorsOfSlots; ++slot)
        found[slot] = wanted[slot] = zero;
    // Sum penalties and adjoints over the pairs, with a texel per lane
    for (std::size_t i = 0; i < n; i += kLane) {
        const std::size_t slot = i / kLane % kVectorsOfSlots;
        const texel<dual> t = {{get(level.x + i), one, zero, zero, zero, zero},
                               {get(level.x + n + i), zero, one, zero, zero, zero},
                               {get(level.x + 2 * n + i), zero, zero, one, zero, zero},
                               {get(level.x + 3 * n + i), zero, zero, zero, one, zero},
                               {get(level.x + 4 * n + i), zero, zero, zero, zero, one}};
        const lobe_place<dual> place = lobe_place_of(t);
        real sum = zero, adjoint[kPlanes] = {zero, zero, zero, zero, zero}, lighter[kPlanes] = {zero, zero, zero, zero, zero};
        for (std::size_t p = 0; p < pairs; ++p) {
            const dual r = radiance<lobe>(place, m.lights[p * kVectorsOfSlots + slot]);
            const real truth = get(m.truth[k] + p * n + i);
            const tone_pair shown = shown_as(work.tone, r.v);
            const penalty off = penalty_of(work.kind, shown.shown - shown_as(work.tone, truth).shown);
            sum += off.value;
            const real by = off.slope * shown.slope;
            adjoint[0] += by * r.d0, adjoint[1] += by * r.d1, adjoint[2] += by * r.d2, adjoint[3] += by * r.d3, adjoint[4] += by * r.d4;
            if (work.light == 0.0f)
                continue;
            found[slot] += r.v, wanted[slot] += truth;
            lighter[0] += r.d0, lighter[1] += r.d1, lighter[2] += r.d2, lighter[3] += r.d3, lighter[4] += r.d4;
        }
        // Store the gradient
        for (std::size_t c = 0; c < kPlanes; ++c) {
            put(level.adjoint + c * n + i, adjoint[c] * share);
            if (work.light != 0.0f)
                put(m.pong + c * n + i, lighter[c]);
        }
        put(loss + slot * kLane, get(loss + slot * kLane) + sum * share);
    }
    if (work.light == 0.0f)
        return;
    // Add |found / wanted - 1| for the level's total reflected light in each tile. A tile is a lane.
    const real weight = lit(work.level_weight[k - 1] * static_cast<double>(work.light) / static_cast<double>(kSlotCount));
    for (std::size_t slot = 0; slot < kVectorsOfSlots; ++slot) {
        const real over = weight / max(wanted[slot], lit(1e-6)), off = found[slot] - wanted[slot];
        put(loss + slot * kLane, get(loss + slot * kLane) + max(off, -off) * over);
        const real by = select(off > zero, over, select(off < zero, -over, zero));
        for (std::size_t c = 0; c < kPlanes; ++c)
            for (std::size_t i = slot * kLane; i < n; i += kSlotCount) {
                number* const to = level.adjoint + c * n + i;
                put(to, get(to) + get(m.pong + c * n + i) * by);
            }
    }
}

// Propagates adjoints through a net's layers. m.ping holds the outputs' adjoints. Returns the features' adjoints, block by block.
const number* backward_layers(const net::StepWork& work, StepMemory& m, const Dense& d, const NetMemory& kept, std::size_t n)
{
    const auto* turned = static_cast<const number*>(work.turned);
    auto* gradient = static_cast<number*>(work.gradient);
    number *dy = m.ping, *dx = m.pong;
    for (int l = d.count - 1; l >= 0; --l) {
        const int in = d.width[l], out = d.width[l + 1];
        weight_gradients(dy, block_size(d, l + 1), kept.layer[l], block_size(d, l), n, in, out, gradient + d.weights[l] * kSlotCount);
        bias_gradients(dy, block_size(d, l + 1), n, out, gradient + d.bias[l] * kSlotCount);
        for (std::size_t b = 0; b < blocks_of(n); ++b) {
            number* const to = dx + b * block_size(d, l);
            dense<After::nothing>(turned + d.weights[l], nullptr, dy + b * block_size(d, l + 1), out, in, in_block(n, b), to);
            if (l == 0)
                continue;
            const number* const h = kept.layer[l] + b * block_size(d, l);
            for (std::size_t row = 0; row < static_cast<std::size_t>(in); ++row)
                for (std::size_t i = 0; i < in_block(n, b); i += kLane) {
                    const real slope = select(get(h + row * kRow + i) > lit(0.0), lit(1.0), lit(static_cast<double>(net::kLeak)));
                    put(to + row * kRow + i, get(to + row * kRow + i) * slope);
                }
        }
        number* const other = dy;
        dy = dx, dx = other;
    }
    return dy;
}

// Writes the adjoints of a net's outputs to m.ping, from its texels' adjoints.
__attribute__((noinline)) void backward_outputs(const net::StepWork& work, StepMemory& m, const Dense& d, const NetMemory& kept,
                                                const Sources& s, const number* adjoint)
{
    const auto* weights = static_cast<const number*>(work.weights);
    const real zero = lit(0.0), one = lit(1.0);
    for (std::size_t b = 0; b < blocks_of(s.n); ++b)
        for (std::size_t i = 0; i < in_block(s.n, b); i += kLane) {
            real f[kMostFeatures];
            const closed_form<real> closed = look_here(*work.plan, weights, s, b * kBlock + i, f);
            const number* const outputs = kept.layer[d.count] + b * block_size(d, d.count) + i;
            const dual o[kPlanes] = {{get(outputs), one, zero, zero, zero, zero},
                                     {get(outputs + kRow), zero, one, zero, zero, zero},
                                     {get(outputs + 2 * kRow), zero, zero, one, zero, zero},
                                     {get(outputs + 3 * kRow), zero, zero, zero, one, zero},
                                     {get(outputs + 4 * kRow), zero, zero, zero, zero, one}};
            dual made[kPlanes];
            channels_of(settle(work.plan->layout, closed, o), made);
            real sum[kPlanes] = {zero, zero, zero, zero, zero};
            for (std::size_t c = 0; c < kPlanes; ++c) {
                const real by = get(adjoint + c * s.n + b * kBlock + i);
                sum[0] += by * made[c].d0, sum[1] += by * made[c].d1, sum[2] += by * made[c].d2, sum[3] += by * made[c].d3,
                    sum[4] += by * made[c].d4;
            }
            for (std::size_t c = 0; c < kPlanes; ++c)
                put(m.ping + b * block_size(d, d.count) + c * kRow + i, sum[c]);
        }
}

struct Adjoints { // planes of the texels that a net saw; null: not needed
    number *children, *grandchildren = nullptr, *great = nullptr, *first = nullptr;
};

// Propagates adjoints from a net's features and result to the texels that it saw, and to kappa.
__attribute__((noinline)) void backward_sources(const net::StepWork& work, StepMemory& m, const Dense& d, const NetMemory& kept,
                                                const Sources& s, const number* adjoint, const number* features, const Adjoints& below)
{
    const auto* weights = static_cast<const number*>(work.weights);
    auto* const kappa = static_cast<number*>(work.gradient) + work.plan->kappa * kSlotCount;
    tape& on = m.on;
    const auto spread = [](const texel<var>& x, number* planes, std::size_t per_plane, std::size_t at) {
        if (!planes)
            return;
        var channels[kPlanes];
        channels_of(x, channels);
        for (std::size_t c = 0; c < kPlanes; ++c) {
            number* const to = planes + c * per_plane + at;
            put(to, get(to) + adjoint_of(channels[c]));
        }
    };
    for (std::size_t b = 0; b < blocks_of(s.n); ++b)
        for (std::size_t i = 0; i < in_block(s.n, b); i += kLane) {
            const std::size_t at = b * kBlock + i;
            // Record the closed form and the features on the tape
            tape_begin(on);
            const var k0 = leaf(on, all_lanes(weights[work.plan->kappa])), k1 = leaf(on, all_lanes(weights[work.plan->kappa + 1]));
            const seen_texels<var> seen = gathered<var>(s, at, k0, k1, [&on](real v) { return leaf(on, v); });
            var f[kMostFeatures];
            const closed_form<var> closed = look(work.plan->layout, seen, f);
            const number* const outputs = kept.layer[d.count] + b * block_size(d, d.count) + i;
            real o[kPlanes];
            for (std::size_t c = 0; c < kPlanes; ++c)
                o[c] = get(outputs + c * kRow);
            var made[kPlanes];
            channels_of(settle(work.plan->layout, closed, o), made);
            // Seed the adjoints, and read the tape backward
            for (std::size_t c = 0; c < kPlanes; ++c)
                seed(made[c], get(adjoint + c * s.n + at));
            for (int k = 0; k < d.width[0]; ++k)
                seed(f[k], get(features + b * block_size(d, 0) + static_cast<std::size_t>(k) * kRow + i));
            tape_reverse(on);
            // Add the adjoints to the planes below
            for (std::size_t j = 0; j < 4; ++j)
                spread(seen.four[j], below.children, 4 * s.n, j * s.n + at);
            if (s.all()) {
                for (std::size_t j = 0; j < 16; ++j)
                    spread(seen.sixteen[j], below.grandchildren, 16 * s.n, j * s.n + at);
                for (std::size_t j = 0; s.far && s.great && j < 64; ++j)
                    spread(seen.sixtyfour[j], below.great, 64 * s.n, j * s.n + at);
                spread(seen.first, below.first, s.n, at);
            }
            const std::size_t slot = at % kSlotCount;
            put(kappa + slot, get(kappa + slot) + adjoint_of(k0));
            put(kappa + kSlotCount + slot, get(kappa + kSlotCount + slot) + adjoint_of(k1));
        }
}

template <int lobe> void step_of(const net::StepWork& work)
{
    const Plan& plan = *work.plan;
    Pool pool = {static_cast<char*>(work.memory)};
    StepMemory m = step_memory(pool, plan, work.pair_count);
    const auto* weights = static_cast<const number*>(work.weights);
    // Light the tiles
    make_lights<lobe>(work, m);
    make_truth<lobe>(work, m);
    const auto sources = [&](int k, bool all) {
        const auto* const texels = static_cast<const number*>(work.texels);
        const auto planes = [&](int level) { return level == 0 ? texels : m.level[level].x; };
        return Sources{planes(k - 1),
                       all ? planes(k - 2) : nullptr,
                       all && plan.far && k >= 3 ? planes(k - 3) : nullptr,
                       all ? m.level[k].first : nullptr,
                       m.level[k].n,
                       plan.far};
    };
    const auto has_b = [&](int k) { return k >= 2 && plan.b.count > 0; };
    // Forward: make all levels
    for (int k = 1; k <= net::kTrainedLevels; ++k) {
        const Level& level = m.level[k];
        for (std::size_t b = 0; b < blocks_of(level.n); ++b)
            forward_block(plan, weights, plan.a, sources(k, false), b, b, level.a, has_b(k) ? level.first : level.x);
        for (std::size_t b = 0; has_b(k) && b < blocks_of(level.n); ++b)
            forward_block(plan, weights, plan.b, sources(k, true), b, b, level.b, level.x);
    }
    // Loss of all levels
    for (std::size_t i = 0; i < net::kTrainedLevels * kSlotCount; ++i)
        static_cast<number*>(work.loss)[i] = 0;
    for (int k = 1; k <= net::kTrainedLevels; ++k)
        make_loss<lobe>(work, m, k);
    // Backward, from the last level to the first
    for (int k = net::kTrainedLevels; k >= 1; --k) {
        const Level& level = m.level[k];
        number* const children = m.level[k - 1].adjoint;
        const number* adjoint = level.adjoint;
        if (has_b(k)) {
            for (std::size_t i = 0; i < kPlanes * level.n; ++i)
                level.first_adjoint[i] = 0;
            backward_outputs(work, m, plan.b, level.b, sources(k, true), adjoint);
            const number* const features = backward_layers(work, m, plan.b, level.b, level.n);
            backward_sources(
                work, m, plan.b, level.b, sources(k, true), adjoint, features,
                {children, m.level[k - 2].adjoint, plan.far && k >= 3 ? m.level[k - 3].adjoint : nullptr, level.first_adjoint});
            adjoint = level.first_adjoint;
        }
        backward_outputs(work, m, plan.a, level.a, sources(k, false), adjoint);
        const number* const features = backward_layers(work, m, plan.a, level.a, level.n);
        backward_sources(work, m, plan.a, level.a, sources(k, false), adjoint, features, {children});
    }
}

void step(const net::StepWork& work)
{
    switch (work.plan->lobe) {
    case net::Lobe::ggx_aniso:
        return step_of<0>(work);
    case net::Lobe::beckmann:
        return step_of<1>(work);
    case net::Lobe::ashikhmin_shirley:
        return step_of<2>(work);
    }
}

#ifndef BN_ORACLE
template <int lobe> void radiance_of(const net::RadianceWork& w)
{
    const real f0 = splat(w.f0), diffuse = splat(w.diffuse);
    for (std::size_t i = 0; i < w.texels; i += kLane) {
        const int n = w.texels - i < kLane ? static_cast<int>(w.texels - i) : kLanes;
        const auto at = [&](const float* planes, std::size_t c) { return load_first(planes + c * w.texels + i, n); };
        const texel<real> t = {at(w.planes, 0), at(w.planes, 1), at(w.planes, 2), at(w.planes, 3), at(w.planes, 4)};
        const real3 to_light = vec3_of(at(w.to_light, 0), at(w.to_light, 1), at(w.to_light, 2));
        const real3 to_eye = vec3_of(at(w.to_eye, 0), at(w.to_eye, 1), at(w.to_eye, 2));
        const light l = light_of<lobe>(to_light, to_eye, f0, diffuse, at(w.intensity, 0));
        store_first(w.out + i, radiance<lobe>(lobe_place_of(t), l), n);
    }
}
#endif

void radiances([[maybe_unused]] const net::RadianceWork& work)
{
#ifndef BN_ORACLE
    switch (work.lobe) {
    case net::Lobe::ggx_aniso:
        return radiance_of<0>(work);
    case net::Lobe::beckmann:
        return radiance_of<1>(work);
    case net::Lobe::ashikhmin_shirley:
        return radiance_of<2>(work);
    }
#endif
}

void toned([[maybe_unused]] std::size_t count, [[maybe_unused]] const float* from, [[maybe_unused]] float* to)
{
#ifndef BN_ORACLE
    for (std::size_t i = 0; i < count; i += kLane)
        store(to + i, tone(load(from + i)).shown);
#endif
}

constexpr net::Fns kFns = {sizeof(number), forward_bytes, forward, step_bytes, step, radiances, toned};

} // namespace
} // namespace mipnet_lanes

BN_DEFINE_FNS(mipnet::Fns, mipnet_lanes::kFns)

} // namespace BN_ISA_NS
} // namespace burnish
