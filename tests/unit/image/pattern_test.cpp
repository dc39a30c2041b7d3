// Patterns of errors: known combs, steps between quads and at tiles, and noise of references, which must not count.
#include "core/image/metrics/pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "core/math/scalar_math.h"

namespace burnish {
namespace {

constexpr int kWidth = 256, kHeight = 192;

// Returns a smooth picture times exp(error).
Image picture_with(const std::function<double(int, int)>& error, int channels = 3)
{
    Image image = make_image(kWidth, kHeight, channels, PixelType::f32);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < channels; ++c)
                image.f32()[(y * kWidth + x) * channels + c] =
                    c == 3 ? 1.0f : static_cast<float>((0.5 + 0.3 * std::sin(0.02 * x) * std::cos(0.03 * y)) * std::exp(error(x, y)));
    return image;
}

// Returns independent errors of the given deviation.
std::function<double(int, int)> noise(double deviation, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, deviation);
    std::vector<double> values(static_cast<std::size_t>(kWidth) * kHeight);
    for (double& v : values)
        v = normal(random);
    return [values](int x, int y) { return values[static_cast<std::size_t>(y * kWidth + x)]; };
}

double nothing(int, int)
{
    return 0.0;
}

TEST(pattern, combs_have_their_period_axis_and_size)
{
    const Image reference = picture_with(nothing);
    for (const double period : {2.0, 3.0, 4.0, 6.5})
        for (const bool along_y : {false, true}) {
            const Image test = picture_with([&](int x, int y) { return 0.05 * std::cos(2.0 * kPi * (along_y ? y : x) / period); });
            const PatternFigures f = pattern_figures(reference, nullptr, test, Jobs(2));
            const double rms = period == 2.0 ? 0.05 : 0.05 / std::sqrt(2.0);
            EXPECT_EQ(f.period, period);
            EXPECT_EQ(f.along_y, along_y);
            EXPECT_NEAR(f.rms, rms, 0.02 * rms) << period;
            EXPECT_NEAR(f.period_rms, rms, 0.04 * rms) << period;
        }
}

TEST(pattern, slow_errors_do_not_count)
{
    const Image test = picture_with([](int x, int y) { return 0.2 + 0.3 * std::cos(2.0 * kPi * (x + y) / 120.0); });
    const PatternFigures f = pattern_figures(picture_with(nothing), nullptr, test, Jobs(1));
    EXPECT_LT(f.rms, 0.012); // 0.21 by itself; what is left stands at the picture's sides
}

TEST(pattern, steps_between_quads_and_at_tiles_show_in_their_ratios)
{
    const Image reference = picture_with(nothing);
    const auto error = noise(0.02, 5);
    const PatternFigures plain = pattern_figures(reference, nullptr, picture_with(error), Jobs(1));
    for (int axis : {0, 1}) {
        EXPECT_NEAR(plain.quad_ratio[axis], 1.0, 0.06);
        EXPECT_NEAR(plain.tile_ratio[axis], 1.0, 0.25);
    }
    // quads that share three quarters of their variance: steps between them have 2 variances, those within 1/2
    const auto shared = noise(0.02 * std::sqrt(3.0), 6);
    const PatternFigures quads =
        pattern_figures(reference, nullptr, picture_with([&](int x, int y) { return error(x, y) + shared(x & ~1, y & ~1); }), Jobs(1));
    for (int axis : {0, 1})
        EXPECT_NEAR(quads.quad_ratio[axis], 4.0, 0.3);
    const PatternFigures tiles =
        pattern_figures(reference, nullptr, picture_with([&](int x, int y) { return error(x, y) + (x / 64 % 2 ? 0.06 : 0.0); }), Jobs(1));
    EXPECT_GT(tiles.tile_ratio[0], 2.5);
    EXPECT_NEAR(tiles.tile_ratio[1], 1.0, 0.25);
}

TEST(pattern, a_second_reference_takes_noise_out)
{
    const Image first = picture_with(noise(0.05, 1)), second = picture_with(noise(0.05, 2));
    const Image test = picture_with([](int x, int) { return x & 1 ? 0.02 : -0.02; });
    EXPECT_NEAR(pattern_figures(first, nullptr, test, Jobs(1)).rms, std::hypot(0.05, 0.02), 0.002);
    const PatternFigures f = pattern_figures(first, &second, test, Jobs(1));
    EXPECT_NEAR(f.rms, 0.02, 0.001);
    EXPECT_EQ(f.period, 2.0);
    EXPECT_LT(pattern_figures(first, &second, picture_with(nothing), Jobs(1)).rms, 0.008);
}

TEST(pattern, a_variance_takes_noise_out)
{
    const double deviation = 0.05;
    const Image first = picture_with(noise(deviation, 1)), plain = picture_with(nothing);
    for (const int channels : {1, 3, 4}) {
        const auto as = [&](const std::function<double(int, int)>& error) { return picture_with(error, channels); };
        Image variance = as(nothing);
        for (std::size_t i = 0; i < variance.bytes.size() / sizeof(float); ++i)
            variance.f32()[i] = static_cast<float>(std::pow(deviation * static_cast<double>(variance.f32()[i]), 2.0));
        const Image reference = as(noise(deviation, 1)), test = as([](int x, int) { return x & 1 ? 0.02 : -0.02; });
        const PatternFigures f = pattern_figures(reference, nullptr, test, Jobs(2), &variance);
        EXPECT_NEAR(f.rms, 0.02, 0.002) << channels;
        EXPECT_EQ(f.period, 2.0);
        EXPECT_LT(pattern_figures(reference, nullptr, as(nothing), Jobs(1), &variance).rms, 0.008);
    }
    Image one_pass = picture_with(nothing);
    one_pass.f32()[3 * (kWidth * 20 + 20)] = std::numeric_limits<float>::infinity();
    const PatternFigures unknown = pattern_figures(first, nullptr, plain, Jobs(1), &one_pass);
    EXPECT_TRUE(std::isnan(unknown.rms) && std::isnan(unknown.quad_ratio[0]));
    EXPECT_GT(unknown.pixels, 0);
}

TEST(pattern, ratios_keep_their_value_without_the_noise_of_one_reference)
{
    const auto own = noise(0.05, 3), shared = noise(0.05, 4);
    const Image reference = picture_with(noise(0.05, 1)), plain = picture_with(own);
    const Image quads = picture_with([&](int x, int y) { return own(x, y) + shared(x & ~1, y & ~1); });
    Image variance = picture_with(nothing);
    for (std::size_t i = 0; i < variance.bytes.size() / sizeof(float); ++i)
        variance.f32()[i] = static_cast<float>(std::pow(0.05 * static_cast<double>(variance.f32()[i]), 2.0));
    for (int axis : {0, 1}) {
        EXPECT_NEAR(pattern_figures(reference, nullptr, plain, Jobs(1), &variance).quad_ratio[axis], 1.0, 0.1);
        EXPECT_NEAR(pattern_figures(reference, nullptr, quads, Jobs(1), &variance).quad_ratio[axis], 2.0, 0.2);
    }
}

TEST(pattern, ratios_keep_their_value_under_noise_of_references)
{
    // noise of the references as strong as the test's own error: quads that share half of their variance have a ratio of 2
    const auto own = noise(0.05, 3), shared = noise(0.05, 4);
    const Image first = picture_with(noise(0.05, 1)), second = picture_with(noise(0.05, 2));
    const Image plain = picture_with(own), quads = picture_with([&](int x, int y) { return own(x, y) + shared(x & ~1, y & ~1); });
    for (int axis : {0, 1}) {
        EXPECT_NEAR(pattern_figures(first, &second, plain, Jobs(1)).quad_ratio[axis], 1.0, 0.1);
        EXPECT_NEAR(pattern_figures(first, &second, quads, Jobs(1)).quad_ratio[axis], 2.0, 0.2);
        EXPECT_LT(pattern_figures(first, nullptr, quads, Jobs(1)).quad_ratio[axis], 1.7);
    }
}

TEST(pattern, only_pixels_inside_surfaces_count)
{
    Image reference = picture_with(nothing, 4), test = reference;
    EXPECT_EQ(pattern_figures(reference, nullptr, test, Jobs(1)).pixels, (kWidth - 4) * (kHeight - 4));
    // a column without coverage, and wild colours near it
    for (int y = 0; y < kHeight; ++y) {
        reference.f32()[(y * kWidth + 100) * 4 + 3] = 0.5f;
        test.f32()[(y * kWidth + 101) * 4] = 50.0f;
    }
    const PatternFigures f = pattern_figures(reference, nullptr, test, Jobs(1));
    EXPECT_EQ(f.pixels, (kWidth - 4 - 5) * (kHeight - 4));
    EXPECT_EQ(f.rms, 0.0);
    // nothing is inside
    const Image black = make_image(8, 8, 3, PixelType::f32);
    EXPECT_EQ(pattern_figures(black, nullptr, black, Jobs(1)).pixels, 0);
    const Image one = make_image(1, 1, 1, PixelType::u8);
    EXPECT_EQ(pattern_figures(one, nullptr, one, Jobs(1)).pixels, 0);
}

TEST(pattern, threads_make_no_difference)
{
    const Image reference = picture_with(noise(0.05, 1)), test = picture_with(noise(0.05, 2));
    const PatternFigures a = pattern_figures(reference, nullptr, test, Jobs(1)), b = pattern_figures(reference, nullptr, test, Jobs(3));
    EXPECT_EQ(a.rms, b.rms);
    EXPECT_EQ(a.period_rms, b.period_rms);
    EXPECT_EQ(a.quad_ratio[0], b.quad_ratio[0]);
    EXPECT_EQ(a.tile_ratio[1], b.tile_ratio[1]);
}

} // namespace
} // namespace burnish
