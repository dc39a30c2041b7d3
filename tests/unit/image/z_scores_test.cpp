#include "core/image/metrics/z_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace burnish {
namespace {

Image filled(int width, int height, int channels, float value)
{
    Image image = make_image(width, height, channels, PixelType::f32);
    std::fill_n(image.f32(), image.bytes.size() / 4, value);
    return image;
}

// Returns means of independent noise with the given deviation.
Image noisy(int width, int height, float mean, float deviation, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Image image = make_image(width, height, 3, PixelType::f32);
    for (std::size_t i = 0; i < image.bytes.size() / 4; ++i)
        image.f32()[i] = mean + deviation * static_cast<float>(normal(random));
    return image;
}

TEST(sidak, one_test_has_the_limits_of_the_normal_distribution)
{
    EXPECT_NEAR(sidak_limit(0.05, 1), 1.959963985, 1e-8);
    EXPECT_NEAR(sidak_limit(0.01, 1), 2.575829304, 1e-8);
    EXPECT_NEAR(sidak_limit(0.5, 1), 0.674489750, 1e-8);
}

TEST(sidak, many_tests_share_the_level)
{
    for (const std::int64_t n : {2ll, 1000ll, 24883200ll, 1ll << 30}) {
        const double single = -std::expm1(std::log1p(-0.01) / static_cast<double>(n));
        const double limit = sidak_limit(0.01, n);
        EXPECT_NEAR(std::erfc(limit / std::sqrt(2.0)) / single, 1.0, 1e-9) << n;
    }
    EXPECT_LT(sidak_limit(0.01, 10), sidak_limit(0.01, 11));
}

TEST(z_scores, equal_pictures_pass_even_without_variance)
{
    const Image a = filled(4, 4, 3, 1.0f), none = filled(4, 4, 3, 0.0f);
    const ZTest result = z_test(a, a, none, nullptr, 0.01, Jobs(1));
    EXPECT_EQ(result.limit, sidak_limit(0.01, 4 * 4 * 3)); // a test for each channel
    EXPECT_EQ(result.largest, 0.0);
    EXPECT_EQ(result.rejected, 0);
}

TEST(z_scores, a_difference_without_variance_is_rejected)
{
    Image a = filled(4, 4, 3, 1.0f), b = a;
    b.f32()[7] = 1.0001f;
    const ZTest result = z_test(a, b, filled(4, 4, 3, 0.0f), nullptr, 0.01, Jobs(1));
    EXPECT_EQ(result.largest, std::numeric_limits<double>::infinity());
    EXPECT_EQ(result.rejected, 1);
    EXPECT_DOUBLE_EQ(result.rejected_fraction, 1.0 / 16);
}

TEST(z_scores, variances_of_both_pictures_add)
{
    const Image a = filled(2, 2, 1, 0.0f), b = filled(2, 2, 1, 5.0f), one = filled(2, 2, 1, 1.0f), three = filled(2, 2, 1, 3.0f);
    EXPECT_DOUBLE_EQ(z_test(a, b, one, nullptr, 0.01, Jobs(1)).largest, 5.0);
    const ZTest both = z_test(a, b, one, &three, 0.01, Jobs(1));
    EXPECT_DOUBLE_EQ(both.largest, 2.5);
    EXPECT_EQ(both.limit, sidak_limit(0.01, 4));
    EXPECT_EQ(both.rejected, 0); // four tests have the limit 3.02
    EXPECT_EQ(z_test(a, b, one, nullptr, 0.01, Jobs(1)).rejected, 4);
}

TEST(z_scores, the_limit_decides)
{
    const Image a = filled(1, 1, 1, 0.0f), variance = filled(1, 1, 1, 1.0f);
    const float limit = static_cast<float>(sidak_limit(0.05, 1));
    EXPECT_EQ(z_test(a, filled(1, 1, 1, 0.999f * limit), variance, nullptr, 0.05, Jobs(1)).rejected, 0);
    EXPECT_EQ(z_test(a, filled(1, 1, 1, 1.001f * limit), variance, nullptr, 0.05, Jobs(1)).rejected, 1);
}

TEST(z_scores, alpha_is_not_tested)
{
    Image a = filled(2, 1, 4, 1.0f), b = a;
    b.f32()[3] = 0.0f;
    EXPECT_EQ(z_test(a, b, filled(2, 1, 4, 1e-6f), nullptr, 0.01, Jobs(1)).rejected, 0);
}

// At 1 % significance few of 40 equally distributed image pairs are told apart. Images one deviation apart always are.
TEST(z_scores, noise_passes_and_bias_does_not)
{
    const Image variance = filled(64, 64, 3, 0.01f); // deviation 0.1
    int told_apart = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        const Image a = noisy(64, 64, 0.5f, 0.1f, 2 * seed), b = noisy(64, 64, 0.5f, 0.1f, 2 * seed + 1);
        told_apart += z_test(a, b, variance, &variance, 0.01, Jobs(1)).rejected > 0 ? 1 : 0;
    }
    EXPECT_LE(told_apart, 3); // more has a probability of 1e-4
    const ZTest biased = z_test(noisy(64, 64, 0.5f, 0.1f, 100), noisy(64, 64, 0.8f, 0.1f, 101), variance, &variance, 0.01, Jobs(1));
    EXPECT_GT(biased.rejected, 0);
}

TEST(z_scores, the_same_bits_for_every_thread_count)
{
    const Image a = noisy(50, 70, 0.5f, 0.1f, 1), b = noisy(50, 70, 0.9f, 0.1f, 2), variance = filled(50, 70, 3, 0.01f);
    const ZTest one = z_test(a, b, variance, nullptr, 0.01, Jobs(1)), many = z_test(a, b, variance, nullptr, 0.01, Jobs(4));
    EXPECT_EQ(one.largest, many.largest);
    EXPECT_EQ(one.rejected, many.rejected);
    EXPECT_GT(one.rejected, 0);
}

} // namespace
} // namespace burnish
