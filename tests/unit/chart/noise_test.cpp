// Noise of a reference, estimated from its variance and from two independent references.
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <limits>

#include "apps/chart/noise.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

Image flat(int width, int height, float value)
{
    Image image = make_image(width, height, 3, PixelType::f32);
    std::fill_n(image.f32(), static_cast<std::size_t>(width * height) * 3, value);
    return image;
}

TEST(chart_noise, has_the_variance_that_was_asked_for)
{
    const Image mean = flat(200, 100, 5.0f), variance = flat(200, 100, 0.25f);
    const Image noisy = with_noise(mean, variance, 1, Jobs(2));
    double sum = 0.0, squares = 0.0, fourths = 0.0, neighbours = 0.0;
    for (std::size_t i = 0; i < 20000; ++i) {
        const double d = static_cast<double>(noisy.f32()[3 * i]) - 5.0;
        EXPECT_EQ(noisy.f32()[3 * i], noisy.f32()[3 * i + 2]);
        sum += d, squares += d * d, fourths += d * d * d * d;
        if (i > 0)
            neighbours += d * (static_cast<double>(noisy.f32()[3 * i - 3]) - 5.0);
    }
    EXPECT_NEAR(sum / 20000, 0.0, 4 * 0.5 / std::sqrt(20000.0));
    EXPECT_NEAR(squares / 20000, 0.25, 4 * 0.25 * std::sqrt(2.0 / 20000));
    EXPECT_NEAR(fourths / 20000, 3 * 0.0625, 0.012); // for a normal distribution
    EXPECT_NEAR(neighbours / 20000, 0.0, 4 * 0.25 / std::sqrt(20000.0));
    EXPECT_EQ(with_noise(mean, variance, 1, Jobs(1)).bytes, noisy.bytes);
    EXPECT_NE(with_noise(mean, variance, 2, Jobs(1)).bytes, noisy.bytes);
    EXPECT_EQ(with_noise(mean, flat(200, 100, 0.0f), 1, Jobs(1)).bytes, mean.bytes);
}

TEST(chart_noise, of_one_pass_is_unknown)
{
    Image variance = flat(8, 8, 0.1f);
    EXPECT_TRUE(std::isfinite(noise_flip(flat(8, 8, 1.0f), variance, best_isa(), Jobs(1))));
    variance.f32()[7] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(std::isnan(noise_flip(flat(8, 8, 1.0f), variance, best_isa(), Jobs(1))));
}

// Two independent references differ by twice their variance. Their FLIP error equals the error after adding that much noise to one of them.
TEST(chart_noise, is_what_two_references_differ_by)
{
    BN_NEEDS_EMBREE();
    Stage stage(ball_scene(metal(0.4f, 0.0f), false), 1.0f, 2);
    stage.environment = environment_of(
        [](const glm::vec3& d) {
            return glm::vec3(0.3f, 0.4f, 0.6f) + (d.y > 0.9f ? glm::vec3(40.0f, 30.0f, 20.0f) : glm::vec3(0.0f)) +
                   (d.x > 0.8f ? glm::vec3(2.0f, 8.0f, 3.0f) : glm::vec3(0.0f));
        },
        64, stage.jobs);
    FrameDesc desc = desc_of(96, 96, make_view({0.0f, 1.0f, 3.5f}, glm::vec3(0.0f), 0.7f, 96, 96));
    for (const std::uint64_t samples : {256ull, 1024ull}) {
        ReferenceOptions options;
        options.samples = samples;
        desc.seed = 1;
        const Frame one = render_reference(stage, desc, options);
        desc.seed = 2;
        const Frame other = render_reference(stage, desc, options);
        Image both = one.variance;
        for (std::size_t i = 0; i < both.bytes.size() / sizeof(float); ++i)
            both.f32()[i] += other.variance.f32()[i];
        const double seen = summarise_errors(flip_hdr(one.color, other.color, {}, stage.jobs).error).mean;
        const double told = noise_flip(one.color, both, best_isa(), stage.jobs);
        std::printf("%d samples: two references differ by a mean FLIP of %.5f, their variances tell %.5f\n", static_cast<int>(samples),
                    seen, told);
        EXPECT_GT(seen, 1e-4);
        EXPECT_NEAR(told / seen, 1.0, 0.2);
    }
}

} // namespace
} // namespace burnish::test
