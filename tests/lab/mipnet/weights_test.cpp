// Weight files, and invalid files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/base/hash.h"
#include "core/simd/half.h"
#include "shading/bake/mipnet/pyramid.h"
#include "shading/lab/mipnet/families.h"

namespace burnish::mipnet {
namespace {

Weights trained_like(bool halves)
{
    Weights w;
    w.shape = {Lobe::beckmann, Layout::cov, {2, 8}, {3, 16}};
    w.seed = 7, w.steps = 100, w.data = 12345;
    w.families = "a, b", w.command = "burnish train mip";
    const Plan plan = plan_of(w.shape);
    w.numbers = start_weights(plan, 2);
    Random random(2);
    for (const Dense* d : {&plan.a, &plan.b}) // outputs as large as after training
        for (std::size_t i = d->weights[d->count - 1]; i < d->bias[d->count - 1] + kChannels; ++i)
            w.numbers[i] = static_cast<float>(random.between(-0.5, 0.5));
    if (halves)
        for (float& number : w.numbers)
            number = half_to_float(float_to_half(number));
    w.numbers[plan.kappa] = 0.5f, w.numbers[plan.kappa + 1] = 0.0f;
    return w;
}

TEST(weights, come_back_from_their_bytes)
{
    const Weights w = trained_like(true);
    const std::vector<std::uint8_t> bytes = weights_bytes(w);
    const Result<Weights> read = parse_weights(bytes.data(), bytes.size(), "w");
    ASSERT_TRUE(read) << read.error().line();
    EXPECT_TRUE(read->shape == w.shape);
    EXPECT_EQ(read->numbers, w.numbers);
    EXPECT_EQ(read->seed, 7u);
    EXPECT_EQ(read->steps, 100u);
    EXPECT_EQ(read->data, 12345u);
    EXPECT_EQ(read->families, w.families);
    EXPECT_EQ(read->command, w.command);
}

TEST(weights, of_one_net_come_back_and_make_pyramids)
{
    Weights w = trained_like(true);
    w.shape.b = {0, 0};
    w.numbers = start_weights(plan_of(w.shape), 2);
    for (float& number : w.numbers)
        number = half_to_float(float_to_half(number));
    const std::vector<std::uint8_t> bytes = weights_bytes(w);
    const Result<Weights> read = parse_weights(bytes.data(), bytes.size(), "w");
    ASSERT_TRUE(read) << read.error().line();
    EXPECT_TRUE(read->shape == w.shape);
    // Zero outputs leave the closed form on every level, for one net and for two.
    const Texels level0 = make_material(families().front(), 3, 64).texels;
    Weights both = trained_like(true);
    both.numbers = start_weights(plan_of(both.shape), 2);
    const auto one = net_pyramid(level0, *read, Jobs(1)), two = net_pyramid(level0, both, Jobs(1));
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t l = 0; l < one.size(); ++l)
        for (std::size_t c = 0; c < kChannels; ++c)
            for (std::size_t i = 0; i < one[l].count(); ++i)
                ASSERT_NEAR(one[l].channel[c][i], two[l].channel[c][i], 1e-3f) << l;
}

TEST(weights, sizes_are_read_as_they_are_named)
{
    for (const char* name : {"2x32/2x64", "1x1", "7x4096/1x3"}) {
        Shape shape;
        ASSERT_TRUE(read_size(name, shape)) << name;
        EXPECT_EQ(size_name(shape), name);
    }
    Shape shape;
    for (const char* name : {"", "2", "2x", "x3", "2x3/", "2x3/4", "2x3/4x", "2x3x4", "2x3/4x5/", "8x3", "2x0", "2x4097", "2x3 ", "-2x3"})
        EXPECT_FALSE(read_size(name, shape)) << name;
}

TEST(weights, that_are_damaged_or_of_something_else_are_refused)
{
    const std::vector<std::uint8_t> good = weights_bytes(trained_like(true));
    const auto refused = [&](std::size_t byte, std::uint32_t word, bool hashed, const char* needle) {
        std::vector<std::uint8_t> bytes = good;
        std::memcpy(bytes.data() + byte, &word, 4);
        if (hashed) {
            const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size() - 8);
            std::memcpy(bytes.data() + bytes.size() - 8, &hash, 8);
        }
        const Result<Weights> read = parse_weights(bytes.data(), bytes.size(), "w");
        ASSERT_FALSE(read) << needle;
        EXPECT_EQ(read.error().code, ExitCode::bad_input);
        EXPECT_NE(read.error().line().find(needle), std::string::npos) << read.error().line();
    };
    refused(0, 0, true, "not weights");
    refused(8, 2, true, "version 2");
    refused(12, 9, true, "lobe 9");
    refused(16, 4, true, "layout 4");
    refused(20, 6, true, "6 channels");
    refused(28, 9, true, "numbers"); // a width that does not match the numbers
    refused(24, 50, true, "50 hidden layers");
    refused(36, 1u << 30, true, "units");
    refused(44, 1u << 30, true, "numbers"); // text without end
    refused(200, 0, false, "hash");
    refused(good.size() - 40, 0x7c007c00u, true, "finite");
    for (const std::size_t size : {std::size_t{0}, std::size_t{79}, std::size_t{120}, good.size() - 1})
        EXPECT_FALSE(parse_weights(good.data(), size, "w")) << size;
}

TEST(weights, as_halves_change_next_to_nothing)
{
    const Texels t = make_material(families()[1], 5, 64).texels;
    const std::vector<Texels> whole = net_pyramid(t, trained_like(false), Jobs(1)), half = net_pyramid(t, trained_like(true), Jobs(1));
    for (std::size_t k = 0; k < whole.size(); ++k)
        for (std::size_t c = 0; c < kChannels; ++c)
            for (std::size_t i = 0; i < whole[k].count(); ++i)
                EXPECT_NEAR(whole[k].channel[c][i], half[k].channel[c][i], 1e-3);
}

} // namespace
} // namespace burnish::mipnet
