// Pyramids by nets: bytes and invariants.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/hash.h"
#include "shading/bake/mipnet/classical.h"
#include "shading/bake/mipnet/pyramid.h"
#include "shading/lab/mipnet/families.h"

namespace burnish::mipnet {
namespace {

Weights some_weights(Layout layout, float output = 0.5f)
{
    Weights w;
    w.shape = {Lobe::ggx_aniso, layout, {2, 12}, {2, 20}};
    const Plan plan = plan_of(w.shape);
    w.numbers = start_weights(plan, 9);
    Random random(4);
    for (const Dense* d : {&plan.a, &plan.b})
        for (std::size_t i = d->weights[d->count - 1]; i < d->bias[d->count - 1] + kChannels; ++i)
            w.numbers[i] = output * static_cast<float>(random.between(-0.3, 0.3));
    return w;
}

Texels some_texels(int width, int height)
{
    const Material m = make_material(families()[0], 1, 256);
    Texels t = make_texels(width, height);
    for (std::size_t c = 0; c < kChannels; ++c)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                t.channel[c][static_cast<std::size_t>(y * width + x)] =
                    m.texels.channel[c][static_cast<std::size_t>(y % 256 * 256 + x % 256)];
    return t;
}

std::uint64_t hash_of(const std::vector<Texels>& levels)
{
    std::uint64_t hash = 0;
    for (const Texels& level : levels)
        for (const std::vector<float>& channel : level.channel)
            hash = hash_bytes(channel.data(), channel.size() * sizeof(float), hash);
    return hash;
}

TEST(pyramid, bytes_depend_on_neither_threads_nor_instruction_sets)
{
    for (const auto& [layout, width, height] : {std::tuple(Layout::paper, 130, 96), {Layout::cov, 130, 96}, {Layout::cov, 36, 144}}) {
        const Weights w = some_weights(layout);
        const Texels t = some_texels(width, height);
        const std::uint64_t wanted = hash_of(net_pyramid(t, w, Jobs(1), Isa::scalar));
        for (const Isa isa : program_isas())
            if (isa_available(isa)) {
                EXPECT_EQ(hash_of(net_pyramid(t, w, Jobs(1), isa)), wanted) << isa_name(isa);
            }
        for (int threads = 2; threads <= 3; ++threads)
            EXPECT_EQ(hash_of(net_pyramid(t, w, Jobs(threads))), wanted) << threads;
    }
}

TEST(pyramid, a_level_map_stays_on_every_level)
{
    for (const double tilt : {0.0, 0.4}) {
        Texels t = make_texels(64, 64);
        const Tensor tensor = tensor_of(0.3, 0.05, 0.6);
        const double v[kChannels] = {tilt, -0.5 * tilt, tensor.a, tensor.b, tensor.c};
        for (std::size_t c = 0; c < kChannels; ++c)
            t.channel[c].assign(t.count(), static_cast<float>(v[c]));
        const std::vector<Texels> levels = net_pyramid(t, some_weights(Layout::cov), Jobs(1));
        for (const Texels& level : levels)
            for (std::size_t c = 0; c < kChannels; ++c)
                for (const float value : level.channel[c])
                    EXPECT_NEAR(value, t.channel[c][0], 1e-4) << c << " at " << level.width;
    }
}

TEST(pyramid, every_size_ends_in_one_valid_texel)
{
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 64}, {257, 129}, {3, 2}, {64, 64}, {5, 1}}) {
        const std::vector<Texels> levels = net_pyramid(some_texels(width, height), some_weights(Layout::cov, 4.0f), Jobs(1));
        EXPECT_EQ(levels.back().count(), 1u);
        for (std::size_t k = 0; k < levels.size(); ++k) {
            EXPECT_EQ(levels[k].width, side_of_level(width, static_cast<int>(k)));
            EXPECT_EQ(levels[k].height, side_of_level(height, static_cast<int>(k)));
            Texels valid = levels[k];
            make_valid(valid);
            for (std::size_t c = 0; c < kChannels; ++c)
                for (std::size_t i = 0; i < valid.count(); ++i)
                    EXPECT_NEAR(valid.channel[c][i], levels[k].channel[c][i], c < 2 ? 0.02 : 1e-5) << width << "x" << height;
        }
    }
}

TEST(pyramid, texels_that_are_no_numbers_spoil_nothing)
{
    Texels t = some_texels(32, 32);
    t.channel[0][5] = std::numeric_limits<float>::quiet_NaN();
    t.channel[3][700] = std::numeric_limits<float>::infinity();
    for (const Texels& level : net_pyramid(t, some_weights(Layout::cov), Jobs(1)))
        for (const std::vector<float>& channel : level.channel)
            for (const float v : channel)
                EXPECT_TRUE(std::isfinite(v));
}

TEST(pyramid, outputs_that_are_zero_leave_the_closed_form)
{
    Weights w = some_weights(Layout::cov, 0.0f);
    const Plan plan = plan_of(w.shape);
    w.numbers[plan.kappa] = 0.5f, w.numbers[plan.kappa + 1] = 0.0f;
    for (const auto& [width, height] : {std::pair(64, 64), {16, 272}}) { // the second in several bands of rows
        const Texels t = some_texels(width, height);
        const std::vector<Texels> found = net_pyramid(t, w, Jobs(1)), wanted = classical_pyramid(t, Method::kappa, 0.5);
        ASSERT_EQ(found.size(), wanted.size());
        for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), width == height ? 7 : 5); ++k) // while no side is 1
            for (std::size_t c = 0; c < kChannels; ++c)
                for (std::size_t i = 0; i < wanted[k].count(); ++i)
                    EXPECT_NEAR(found[k].channel[c][i], wanted[k].channel[c][i], 2e-5) << "level " << k;
    }
}

} // namespace
} // namespace burnish::mipnet
