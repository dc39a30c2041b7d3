#include "shading/lab/mipnet/step_fns.h"

#include "shading/bake/mipnet/forward.h"
#include "shading/lab/mipnet/dense_gradients.h"
#include "shading/lab/mipnet/tape.h"

namespace burnish {
inline namespace BN_ISA_NS {
namespace mipnet_lanes {
namespace {

constexpr std::size_t kSlotCount = net::kSlots, kVectorsOfSlots = kSlotCount / kLane;

// All memory of one shard.
struct Level {
    std::size_t n;
    number *x, *adjoint, *first, *first_adjoint; // planes
    NetMemory a, b;
};
struct StepMemory {
    Level level[net::kTrainedLevels + 1];
    number* target[net::kTrainedLevels + 1]; // radiance by pair and texel; level 0 holds one pair
    number *ping, *pong;                     // adjoints of activations
    light* lights;                           // by pair and vector of slots
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
        m.target[k] = pool.take<number>(k == 0 ? n : pairs * n);
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
template <int lobe> __attribute__((noinline)) void make_target(const net::StepWork& work, StepMemory& m)
{
    for (std::size_t p = 0; p < static_cast<std::size_t>(work.pair_count); ++p) {
        const auto lit_level = [&](const void* planes, std::size_t n, number* to) {
            const auto* x = static_cast<const number*>(planes);
            for (std::size_t i = 0; i < n; i += kLane) {
                const texel<real> t = {get(x + i), get(x + n + i), get(x + 2 * n + i), get(x + 3 * n + i), get(x + 4 * n + i)};
                put(to + i, radiance<lobe>(lobe_place_of(t), m.lights[p * kVectorsOfSlots + i / kLane % kVectorsOfSlots]));
            }
        };
        // Light the target levels, where they are given
        for (int k = 1; work.target_levels && k <= net::kTrainedLevels; ++k)
            lit_level(work.target_levels[k - 1], m.level[k].n, m.target[k] + p * m.level[k].n);
        if (work.target_levels)
            continue;
        // Otherwise light level 0, and average down
        lit_level(work.texels, m.level[0].n, m.target[0]);
        const number* below = m.target[0];
        for (int k = 1; k <= net::kTrainedLevels; ++k) {
            const std::size_t n = m.level[k].n;
            number* const to = m.target[k] + p * n;
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
            const real target = get(m.target[k] + p * n + i);
            const tone_pair shown = shown_as(work.tone, r.v);
            const penalty off = penalty_of(work.kind, shown.shown - shown_as(work.tone, target).shown);
            sum += off.value;
            const real by = off.slope * shown.slope;
            adjoint[0] += by * r.d0, adjoint[1] += by * r.d1, adjoint[2] += by * r.d2, adjoint[3] += by * r.d3, adjoint[4] += by * r.d4;
            if (work.light == 0.0f)
                continue;
            found[slot] += r.v, wanted[slot] += target;
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
    make_target<lobe>(work, m);
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

constexpr net::StepFns kStepFns = {step_bytes, step};

} // namespace
} // namespace mipnet_lanes

BN_DEFINE_FNS(mipnet::StepFns, mipnet_lanes::kStepFns)

} // namespace BN_ISA_NS
} // namespace burnish
