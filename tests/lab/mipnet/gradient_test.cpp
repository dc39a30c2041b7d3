// Gradients of a training step against central differences, in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/image/image.h"
#include "core/math/scalar_math.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mipnet/net.h"
#include "shading/lab/mipnet/step_fns.h"
#include "shading/lab/mipnet/training_batch.h"

namespace burnish::mipnet {
namespace {

// Returns a unit direction above a plane, at least so steep.
std::vector<double> up(Random& random, double least)
{
    const double z = random.between(least, 0.98), turn = random.between(0.0, 6.2), r = std::sqrt(1.0 - z * z);
    return {r * det_cos(turn), r * det_sin(turn), z};
}

// A shard in double precision.
struct Work {
    Plan plan;
    std::vector<double> weights, texels, tiles, pairs, gradient, loss;
    std::vector<std::byte, LineAllocator<std::byte>> memory;
    int pair_count;
    double level_weight[kTrainedLevels] = {0.2, 0.2, 0.2, 0.2, 0.2};
    Loss kind = Loss::l1;
    Tone tone = Tone::display;
    float light = 0.0f;

    double run()
    {
        const StepFns& fns = oracle_fns<StepFns>();
        gradient.assign(plan.count * kSlots, 0.0), loss.assign(kTrainedLevels * kSlots, 0.0);
        memory.resize(fns.bytes(plan, pair_count));
        const std::vector<double> turned = turned_weights(plan, weights);
        fns.step({&plan, weights.data(), turned.data(), texels.data(), tiles.data(), pairs.data(), pair_count, level_weight,
                  gradient.data(), loss.data(), memory.data(), kind, tone, nullptr, light});
        double sum = 0.0;
        for (const double l : loss)
            sum += l;
        return sum;
    }
    double slope(std::size_t i) const
    {
        double sum = 0.0;
        for (std::size_t slot = 0; slot < kSlots; ++slot)
            sum += gradient[i * kSlots + slot];
        return sum;
    }
};

void check_cascade(const Shape& shape, Loss kind = Loss::l1, Tone tone = Tone::display, float light = 0.0f)
{
    const Lobe lobe = shape.lobe;
    const Layout layout = shape.layout;
    const TrainingSet set = make_training_set(1, 64, Jobs(1));
    Work w;
    w.plan = plan_of(shape), w.kind = kind, w.tone = tone, w.light = light;
    Random random(21);
    for (const float v : start_weights(w.plan, 3))
        w.weights.push_back(static_cast<double>(v));
    for (const Dense* d : {&w.plan.a, &w.plan.b}) // and nonzero outputs, so that gradients flow
        for (std::size_t i = d->count ? d->weights[d->count - 1] : 0; d->count && i < d->bias[d->count - 1] + kChannels; ++i)
            w.weights[i] = random.between(-0.3, 0.3) * (layout == Layout::paper ? 0.1 : 1.0);
    w.weights[w.plan.kappa + 1] = 0.1;
    w.pair_count = 1;
    w.pairs.resize(6 * kSlots);
    const Batch batch = make_batch(set, 4, w.pair_count);
    w.texels.assign(batch.texels.begin(), batch.texels.end());
    w.tiles.assign(batch.tiles.begin(), batch.tiles.end());
    // Directions from above: at the horizon radiance jumps, which differences see and derivatives do not.
    for (std::size_t slot = 0; slot < kSlots; ++slot)
        for (std::size_t way = 0; way < 2; ++way) {
            const std::vector<double> d = up(random, 0.93);
            for (std::size_t k = 0; k < 3; ++k)
                w.pairs[(3 * way + k) * kSlots + slot] = d[k];
        }
    w.run();
    Work moved = w;
    std::vector<std::size_t> places = {w.plan.kappa, w.plan.kappa + 1};
    for (const Dense* d : {&w.plan.a, &w.plan.b})
        for (int l = 0; l < d->count; ++l) {
            places.push_back(d->weights[l] + static_cast<std::size_t>(random.below(d->width[l] * d->width[l + 1])));
            places.push_back(d->bias[l] + static_cast<std::size_t>(random.below(d->width[l + 1])));
        }
    for (const std::size_t i : places) {
        if (layout == Layout::paper && i >= w.plan.kappa)
            continue;
        const double step = 1e-6;
        moved.weights[i] = w.weights[i] + step;
        const double high = moved.run();
        moved.weights[i] = w.weights[i] - step;
        const double low = moved.run();
        moved.weights[i] = w.weights[i];
        const double wanted = (high - low) / (2.0 * step);
        EXPECT_NEAR(w.slope(i), wanted, 1e-5 * std::max(1.0, std::fabs(wanted)))
            << lobe_name(lobe) << " " << layout_name(layout) << " " << i;
        EXPECT_GT(std::fabs(wanted), 1e-12) << "nothing is seen of number " << i;
    }
}

TEST(gradient, of_the_whole_cascade_as_a_closed_form_and_what_is_left)
{
    for (const Lobe lobe : {Lobe::ggx_aniso, Lobe::beckmann, Lobe::ashikhmin_shirley})
        check_cascade({lobe, Layout::cov, {2, 6}, {2, 7}});
}

TEST(gradient, of_the_whole_cascade_as_published)
{
    check_cascade({Lobe::ggx_aniso, Layout::paper, {2, 6}, {2, 7}});
}

TEST(gradient, of_the_whole_cascade_without_its_second_net)
{
    check_cascade({Lobe::ggx_aniso, Layout::cov, {2, 6}, {0, 0}});
}

TEST(gradient, of_the_whole_cascade_by_other_losses_and_tones)
{
    for (const Loss kind : {Loss::l2, Loss::charbonnier})
        check_cascade({Lobe::ggx_aniso, Layout::cov, {2, 6}, {2, 7}}, kind);
    check_cascade({Lobe::ggx_aniso, Layout::cov, {2, 6}, {2, 7}}, Loss::l1, Tone::log);
}

TEST(gradient, of_the_whole_cascade_by_mean_radiance)
{
    check_cascade({Lobe::ggx_aniso, Layout::cov, {2, 6}, {2, 7}}, Loss::l1, Tone::display, 4.0f);
}

TEST(gradient, of_the_whole_cascade_that_sees_sixty_four_texels)
{
    for (const Layout layout : {Layout::cov, Layout::paper})
        check_cascade({Lobe::ggx_aniso, layout, {2, 6}, {2, 7}, true});
}

} // namespace
} // namespace burnish::mipnet
