#include "core/image/metrics/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/image/magma.h"

namespace burnish {
namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

Image floats(int width, int height, int channels, const std::vector<float>& values)
{
    Image image = make_image(width, height, channels, PixelType::f32);
    std::copy(values.begin(), values.end(), image.f32());
    return image;
}

Image bytes(int width, int height, int channels, const std::vector<int>& values)
{
    Image image = make_image(width, height, channels, PixelType::u8);
    std::transform(values.begin(), values.end(), image.bytes.begin(), [](int v) { return static_cast<std::byte>(v); });
    return image;
}

Image noise(int width, int height, int channels, unsigned seed)
{
    std::mt19937 random(seed);
    Image image = make_image(width, height, channels, PixelType::f32);
    for (std::size_t i = 0; i < image.bytes.size() / 4; ++i)
        image.f32()[i] = static_cast<float>(random() % 10000) / 5000.0f;
    return image;
}

TEST(metrics, of_equal_pictures_are_all_zero)
{
    const Jobs jobs;
    const Image image = noise(30, 20, 3, 1);
    const PixelFigures figures = pixel_figures(image, image, jobs);
    EXPECT_EQ(figures.mse, 0.0);
    EXPECT_EQ(figures.rel_mse, 0.0);
    EXPECT_EQ(figures.psnr, std::numeric_limits<double>::infinity());
    EXPECT_EQ(figures.max_abs, 0.0);
    EXPECT_EQ(figures.differing_fraction, 0.0);
    EXPECT_DOUBLE_EQ(ssim(image, image, jobs), 1.0);
}

TEST(metrics, equal_those_done_by_hand)
{
    const Jobs jobs;
    const Image a = floats(2, 1, 3, {1, 2, 3, 0, 0, 4}), b = floats(2, 1, 3, {1, 2.5f, 1, 0, 0, 4});
    const PixelFigures figures = pixel_figures(a, b, jobs);
    EXPECT_DOUBLE_EQ(figures.mse, (0.25 + 4.0) / 6);
    EXPECT_DOUBLE_EQ(figures.rel_mse, (0.25 / 4.01 + 4.0 / 9.01) / 6);
    EXPECT_NEAR(figures.psnr, 10 * std::log10(16.0 / figures.mse), 1e-12); // peak 4, the reference's largest value
    EXPECT_EQ(figures.max_abs, 2.0);
    EXPECT_EQ(figures.differing_fraction, 0.5);
}

TEST(metrics, relative_error_is_that_of_the_reference)
{
    const Jobs jobs;
    const Image bright = floats(1, 1, 1, {10}), dark = floats(1, 1, 1, {0});
    EXPECT_DOUBLE_EQ(pixel_figures(bright, dark, jobs).rel_mse, 100 / 100.01);
    EXPECT_DOUBLE_EQ(pixel_figures(dark, bright, jobs).rel_mse, 100 / 0.01);
}

TEST(metrics, display_values_are_in_zero_to_one)
{
    const Jobs jobs;
    const Image a = bytes(2, 2, 1, {0, 255, 100, 51}), b = bytes(2, 2, 1, {0, 204, 100, 51});
    const PixelFigures figures = pixel_figures(a, b, jobs);
    EXPECT_NEAR(figures.mse, 0.04 / 4, 1e-8);
    EXPECT_NEAR(figures.psnr, 20.0, 1e-5); // 10 log10(1 / 0.01)
    EXPECT_NEAR(figures.max_abs, 0.2, 1e-7);
    EXPECT_EQ(figures.differing_fraction, 0.25);
    Image wide = make_image(2, 2, 1, PixelType::u16);
    for (std::size_t i = 0; i < 4; ++i)
        reinterpret_cast<std::uint16_t*>(wide.bytes.data())[i] = static_cast<std::uint16_t>(static_cast<int>(b.bytes[i]) * 257);
    EXPECT_EQ(pixel_figures(a, wide, jobs).mse, figures.mse);
}

TEST(metrics, alpha_differs_but_is_no_colour)
{
    const Jobs jobs;
    const Image a = floats(1, 1, 4, {1, 1, 1, 0}), b = floats(1, 1, 4, {1, 1, 1, 1});
    const PixelFigures figures = pixel_figures(a, b, jobs);
    EXPECT_EQ(figures.mse, 0.0);
    EXPECT_EQ(figures.max_abs, 1.0);
    EXPECT_EQ(figures.differing_fraction, 1.0);
    EXPECT_EQ(peak_value(floats(1, 1, 2, {0.5f, 9})), 0.5);
}

TEST(metrics, one_bit_is_a_difference)
{
    const Jobs jobs;
    Image a = noise(64, 64, 3, 2), b = a;
    b.f32()[3 * 100 + 1] = std::nextafter(b.f32()[3 * 100 + 1], 100.0f);
    EXPECT_EQ(pixel_figures(a, b, jobs).differing_fraction, 1.0 / 4096);
    EXPECT_GT(pixel_figures(a, b, jobs).max_abs, 0.0);
}

TEST(metrics, not_finite_pixels_are_counted_once)
{
    const Image clean = floats(3, 1, 2, {1, 2, 3, 4, 5, 6});
    EXPECT_EQ(not_finite_pixels(clean, clean), 0);
    EXPECT_EQ(not_finite_pixels(clean, floats(3, 1, 2, {kNan, kInf, 3, 4, 5, -kInf})), 2);
    EXPECT_EQ(not_finite_pixels(floats(3, 1, 2, {kNan, 2, 3, 4, 5, 6}), floats(3, 1, 2, {kNan, 2, 3, kInf, 5, 6})), 2);
    EXPECT_EQ(not_finite_pixels(bytes(1, 1, 1, {255}), bytes(1, 1, 1, {0})), 0);
}

// Uniform images have no variance, so the means alone count.
TEST(ssim, of_uniform_pictures_compares_their_means)
{
    const Jobs jobs;
    const Image a = floats(16, 16, 1, std::vector<float>(256, 0.5f)), b = floats(16, 16, 1, std::vector<float>(256, 0.25f));
    const double c1 = 0.01 * 0.5 * 0.01 * 0.5; // peak 0.5
    EXPECT_NEAR(ssim(a, b, jobs), (2 * 0.5 * 0.25 + c1) / (0.25 + 0.0625 + c1), 1e-9);
}

// Returns SSIM by its definition, with whole windows, one after another.
double ssim_by_definition(const Image& a, const Image& b, int margin)
{
    const double peak = static_cast<double>(*std::max_element(a.f32(), a.f32() + a.bytes.size() / 4));
    const double c1 = 1e-4 * peak * peak, c2 = 9e-4 * peak * peak;
    const auto at = [](const Image& image, int x, int y) {
        x = std::clamp(x, 0, image.width - 1), y = std::clamp(y, 0, image.height - 1);
        const float* v = image.f32() + static_cast<std::size_t>((y * image.width + x) * image.channels);
        return image.channels < 3
                   ? static_cast<double>(v[0])
                   : 0.2126 * static_cast<double>(v[0]) + 0.7152 * static_cast<double>(v[1]) + 0.0722 * static_cast<double>(v[2]);
    };
    double sum = 0;
    int windows = 0;
    for (int y = margin; y < a.height - margin; ++y)
        for (int x = margin; x < a.width - margin; ++x, ++windows) {
            double weights = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int j = -5; j <= 5; ++j)
                for (int i = -5; i <= 5; ++i) {
                    const double w = std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5)), p = at(a, x + i, y + j), q = at(b, x + i, y + j);
                    weights += w, ma += w * p, mb += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
                }
            ma /= weights, mb /= weights;
            const double va = aa / weights - ma * ma, vb = bb / weights - mb * mb, cov = ab / weights - ma * mb;
            sum += (2 * ma * mb + c1) * (2 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
        }
    return sum / windows;
}

TEST(ssim, follows_the_definition)
{
    const Jobs jobs;
    for (const int channels : {1, 3, 4}) {
        const Image a = noise(40, 90, channels, 3), b = noise(40, 90, channels, 4);
        Image mixed = a; // correlated with a
        for (std::size_t i = 0; i < a.bytes.size() / 4; ++i)
            mixed.f32()[i] = 0.7f * a.f32()[i] + 0.3f * b.f32()[i];
        const double value = ssim(a, mixed, jobs);
        EXPECT_LT(value, 0.99);
        EXPECT_GT(value, ssim(a, b, jobs) + 0.1);
        if (channels != 4) { // the definition above would take alpha for the peak
            EXPECT_NEAR(value, ssim_by_definition(a, mixed, 5), 1e-9);
        }
    }
}

TEST(ssim, of_pictures_smaller_than_the_window_follows_the_definition)
{
    const Jobs jobs;
    const Image a = noise(7, 4, 1, 5), b = noise(7, 4, 1, 6);
    EXPECT_NEAR(ssim(a, b, jobs), ssim_by_definition(a, b, 0), 1e-9);
}

TEST(metrics, the_same_bits_for_every_thread_count)
{
    const Image a = noise(301, 203, 3, 7), b = noise(301, 203, 3, 8);
    const PixelFigures one = pixel_figures(a, b, Jobs(1));
    const double similarity = ssim(a, b, Jobs(1));
    for (const int threads : {2, 3, 8}) {
        const PixelFigures many = pixel_figures(a, b, Jobs(threads));
        EXPECT_EQ(many.mse, one.mse);
        EXPECT_EQ(many.rel_mse, one.rel_mse);
        EXPECT_EQ(many.max_abs, one.max_abs);
        EXPECT_EQ(many.differing_fraction, one.differing_fraction);
        EXPECT_EQ(ssim(a, b, Jobs(threads)), similarity);
    }
}

TEST(errors, of_a_ramp_have_its_mean_percentiles_and_ends)
{
    std::vector<float> ramp;
    for (int i = 1; i <= 200; ++i)
        ramp.push_back(static_cast<float>(i) / 200.0f);
    std::shuffle(ramp.begin(), ramp.end(), std::mt19937(9));
    const ErrorSummary summary = summarise_errors(floats(20, 10, 1, ramp));
    EXPECT_NEAR(summary.mean, 0.5025, 1e-9);
    EXPECT_FLOAT_EQ(static_cast<float>(summary.p99), 198.0f / 200.0f); // 198 of 200 do not exceed it
    EXPECT_EQ(summary.max, 1.0);
    // 1 + 2 + ... + n exceeds half of 20100 from n = 142 on.
    EXPECT_FLOAT_EQ(static_cast<float>(summary.weighted_median), 142.0f / 200.0f);
}

TEST(errors, percentiles_are_those_of_the_sorted_list)
{
    std::mt19937 random(10);
    for (const int n : {1, 2, 99, 100, 101, 5000}) {
        std::vector<float> values;
        for (int i = 0; i < n; ++i)
            values.push_back(static_cast<float>(std::pow(static_cast<double>(random()) / 4294967296.0, 6.0)));
        const ErrorSummary summary = summarise_errors(floats(n, 1, 1, values));
        std::sort(values.begin(), values.end());
        const std::size_t rank = static_cast<std::size_t>((99 * n + 99) / 100); // nearest rank, counted from 1
        EXPECT_EQ(summary.p99, static_cast<double>(values[rank - 1])) << n;
        double sum = 0, part = 0;
        for (const float v : values)
            sum += static_cast<double>(v);
        std::size_t i = 0;
        while (part += static_cast<double>(values[i]), part <= 0.5 * sum)
            ++i;
        EXPECT_EQ(summary.weighted_median, static_cast<double>(values[i])) << n;
        EXPECT_NEAR(summary.mean, sum / n, 1e-9);
    }
}

TEST(errors, of_equal_pictures_are_all_zero)
{
    const ErrorSummary summary = summarise_errors(floats(3, 1, 1, {0, 0, -0.0f}));
    EXPECT_EQ(summary.mean, 0.0);
    EXPECT_EQ(summary.p99, 0.0);
    EXPECT_EQ(summary.weighted_median, 0.0);
    EXPECT_EQ(summary.max, 0.0);
}

// The first, middle and last colour of the published table. Magma brightens monotonically.
TEST(magma, ends_and_middle_are_the_published_colours)
{
    const Image colours = magma_map(floats(6, 1, 1, {0, 128.0f / 255.0f, 1, -1, 2, kNan}));
    const std::vector<std::vector<int>> expected = {{0, 0, 4}, {0xb7, 0x37, 0x79}, {0xfc, 0xfd, 0xbf},
                                                    {0, 0, 4}, {0xfc, 0xfd, 0xbf}, {0, 0, 4}};
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(static_cast<int>(colours.bytes[3 * i + c]), expected[i][c]) << i;
}

TEST(magma, every_step_is_lighter_and_small)
{
    Image ramp = make_image(256, 1, 1, PixelType::f32);
    for (int i = 0; i < 256; ++i)
        ramp.f32()[i] = static_cast<float>(i) / 255.0f;
    const Image colours = magma_map(ramp);
    const auto channel = [&](std::size_t i, std::size_t c) { return static_cast<int>(colours.bytes[3 * i + c]); };
    for (std::size_t i = 1; i < 256; ++i) {
        int lighter = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_LE(std::abs(channel(i, c) - channel(i - 1, c)), 4) << i;
            lighter += channel(i, c) - channel(i - 1, c);
        }
        EXPECT_GE(lighter, 0) << i;
    }
}

} // namespace
} // namespace burnish
