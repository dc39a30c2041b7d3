#include "core/image/metrics/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "core/image/colour.h"
#include "core/image/io/image_io.h"
#include "core/image/metrics/flip_lanes.h"
#include "core/image/metrics/metrics.h"
#include "flip_oracle.h"
#include "tests/unit/data.h"

namespace burnish {
namespace {

Image uniform(int width, int height, float r, float g, float b)
{
    Image image = make_image(width, height, 3, PixelType::f32);
    for (std::size_t i = 0; i < image.bytes.size() / 4; i += 3)
        image.f32()[i] = r, image.f32()[i + 1] = g, image.f32()[i + 2] = b;
    return image;
}

// Returns smooth colours with noise and a few hard edges.
Image scenery(int width, int height, unsigned seed, float brightness = 1.0f)
{
    Image image = make_image(width, height, 3, PixelType::f32);
    std::mt19937 random(seed);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                const double wave = 0.5 + 0.4 * std::sin(0.1 * x * (c + 1) + 0.07 * y);
                const double block = (x / 11 + y / 7) % 3 == c ? 0.3 : 1.0;
                const double noise = static_cast<double>(random() % 1000) / 10000.0;
                image.f32()[static_cast<std::size_t>((y * width + x) * 3 + c)] =
                    brightness * static_cast<float>(wave * block * 0.9 + noise);
            }
    return image;
}

Image shifted(const Image& image, float by)
{
    Image out = image;
    for (std::size_t i = 0; i < out.bytes.size() / 4; ++i)
        out.f32()[i] += by;
    return out;
}

double mean_of(const FlipResult& result)
{
    return summarise_errors(result.error).mean;
}

double largest_of(const FlipResult& result)
{
    return summarise_errors(result.error).max;
}

class known : public testing::Test {
  protected:
    static Image picture(const std::string& name)
    {
        Result<Image> image = read_image(test::data_file("flip/" + name), Limits{});
        EXPECT_TRUE(image) << (image ? "" : image.error().line());
        return image ? *image : Image{};
    }
    Jobs jobs;
};

// Means printed by the authors' program, version 1.6, to six digits: SOURCES.md beside the images.
TEST_F(known, ldr_means_are_those_of_the_reference_implementation)
{
    const Image reference = picture("ldr_ref.png");
    EXPECT_NEAR(mean_of(flip_ldr(reference, picture("ldr_blur.png"), {}, jobs)), 0.098760, 2e-6);
    EXPECT_NEAR(mean_of(flip_ldr(reference, picture("ldr_tint.png"), {}, jobs)), 0.263008, 2e-6);
}

// The authors' program includes black pixels in its median. This image has some, so the program's stop is 3.4670.
TEST_F(known, hdr_mean_over_the_published_exposures_is_the_references)
{
    FlipOptions options;
    options.stop_ev = 3.4670f;
    const FlipResult result = flip_hdr(picture("hdr_ref.exr"), picture("hdr_blur.exr"), options, jobs);
    EXPECT_NEAR(mean_of(result), 0.125888, 2e-6);
    EXPECT_NEAR(result.exposures.start_ev, -3.5562f, 1e-4f);
    EXPECT_EQ(result.exposures.count, 8);
}

TEST_F(known, hdr_mean_over_exposures_of_lit_pixels_is_near)
{
    const FlipResult result = flip_hdr(picture("hdr_ref.exr"), picture("hdr_blur.exr"), {}, jobs);
    EXPECT_NEAR(mean_of(result), 0.125888, 1e-4);
    EXPECT_NEAR(result.exposures.start_ev, -3.5562f, 1e-4f);
    EXPECT_NEAR(result.exposures.stop_ev, 3.4670f, 0.02f);
    EXPECT_EQ(result.exposures.count, 8);
}

TEST(flip, default_distance_is_the_published_one)
{
    EXPECT_FLOAT_EQ(kDefaultPpd, static_cast<float>(0.7 * (3840 / 0.7) * std::acos(-1.0) / 180.0));
}

TEST(flip, every_pixel_follows_the_definition)
{
    const Jobs jobs;
    // More than one tile in both directions, at two viewing distances.
    for (const auto& [width, height, ppd] : {std::tuple{262, 132, 30.0f}, {41, 37, kDefaultPpd}, {17, 1, 50.0f}}) {
        const Image a = scenery(width, height, 1, 0.9f), b = scenery(width, height, 2, 0.7f);
        FlipOptions options;
        options.ppd = ppd;
        const Image error = flip_ldr(a, b, options, jobs).error;
        const std::vector<double> expected = test::flip_by_definition(a, b, static_cast<double>(ppd));
        ASSERT_EQ(error.bytes.size() / 4, expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
            ASSERT_NEAR(static_cast<double>(error.f32()[i]), expected[i], 2e-5) << width << "x" << height << " pixel " << i;
    }
}

// The filter skips equal rows, except rows that a difference reaches: single pixels, beside the seam of two tiles, near the border.
TEST(flip, one_pixel_spreads_as_by_the_definition)
{
    const Jobs jobs;
    for (const auto& [x, y] : {std::pair{20, 60}, {3, 127}, {39, 128}, {0, 0}, {17, 149}}) {
        const Image a = scenery(40, 150, 1, 0.9f);
        Image b = a;
        for (int c = 0; c < 3; ++c)
            b.f32()[3 * (y * 40 + x) + c] = 1.0f - b.f32()[3 * (y * 40 + x) + c];
        const Image error = flip_ldr(a, b, {}, jobs).error;
        const std::vector<double> expected = test::flip_by_definition(a, b, static_cast<double>(kDefaultPpd));
        std::size_t seen = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(static_cast<double>(error.f32()[i]), expected[i], 2e-4) << "pixel " << i;
            seen += error.f32()[i] > 0.01f;
        }
        EXPECT_GT(seen, 20u);
    }
}

// Where filters leave almost nothing, as for a checkerboard against its mean, the definition takes roots of differences near 0. Roots
// magnify a float's rounding.
TEST(flip, means_of_patterns_and_mirrored_pictures_are_those_of_the_definition)
{
    const Jobs jobs;
    const int side = 48;
    Image checker = uniform(side, side, 0.0f, 0.0f, 0.0f), stripes = checker, mirrored = checker;
    const Image plain = uniform(side, side, 0.5f, 0.5f, 0.5f), picture = scenery(side, side, 3, 0.9f);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 3; ++c) {
                const int i = 3 * (y * side + x) + c;
                checker.f32()[i] = static_cast<float>((x + y) & 1);
                stripes.f32()[i] = static_cast<float>(x & 1);
                mirrored.f32()[i] = picture.f32()[3 * (y * side + side - 1 - x) + c];
            }
    for (const auto& [reference, test] : std::initializer_list<std::pair<const Image*, const Image*>>{
             {&checker, &plain}, {&plain, &checker}, {&stripes, &plain}, {&picture, &mirrored}}) {
        const std::vector<double> expected = test::flip_by_definition(*reference, *test, static_cast<double>(kDefaultPpd));
        double mean = 0.0;
        for (const double e : expected)
            mean += e / static_cast<double>(expected.size());
        EXPECT_NEAR(mean_of(flip_ldr(*reference, *test, {}, jobs)), mean, 1e-5);
    }
}

TEST(flip, equal_pictures_have_no_error)
{
    const Jobs jobs;
    const Image bright = scenery(70, 50, 3, 40.0f);
    EXPECT_EQ(largest_of(flip_ldr(bright, bright, {}, jobs)), 0.0);
    EXPECT_EQ(largest_of(flip_hdr(bright, bright, {}, jobs)), 0.0);
}

// Green and blue are the display's two most distant colours.
TEST(flip, the_largest_error_is_one)
{
    const Jobs jobs;
    const Image green = uniform(20, 20, 0, 1, 0), blue = uniform(20, 20, 0, 0, 1);
    EXPECT_NEAR(mean_of(flip_ldr(green, blue, {}, jobs)), 1.0, 1e-5);
    const Image a = scenery(90, 90, 4), b = scenery(90, 90, 5, 0.1f);
    EXPECT_LE(largest_of(flip_ldr(a, b, {}, jobs)), 1.0);
}

// Uniform grays have no features and no colour: |L1 - L2|^0.7 scaled.
TEST(flip, uniform_grays_differ_by_their_lightness)
{
    const Jobs jobs;
    const auto lightness = [](double y) { return 116 * std::cbrt(y) - 16; };
    const Image a = uniform(30, 30, 0.5f, 0.5f, 0.5f), b = uniform(30, 30, 0.3f, 0.3f, 0.3f);
    // sRGB's green has L*a*b* 87.73, -86.18, 83.18, its blue 32.30, 79.19, -107.86. Hunt adjustment: a and b times L/100.
    const double da = -86.18 * 0.8773 - 79.19 * 0.3230, db = 83.18 * 0.8773 + 107.86 * 0.3230;
    const double knee = 0.4 * std::pow(87.73 - 32.30 + std::hypot(da, db), 0.7);
    EXPECT_NEAR(mean_of(flip_ldr(a, b, {}, jobs)), std::pow(lightness(0.5) - lightness(0.3), 0.7) * 0.95 / knee, 1e-3);
}

TEST(flip, error_grows_with_the_difference)
{
    const Jobs jobs;
    const Image reference = scenery(64, 64, 6, 0.5f);
    double last_ldr = 0.0, last_hdr = 0.0;
    for (const float by : {0.01f, 0.03f, 0.1f, 0.3f}) {
        const double ldr = mean_of(flip_ldr(reference, shifted(reference, by), {}, jobs));
        const double hdr = mean_of(flip_hdr(reference, shifted(reference, by), {}, jobs));
        EXPECT_GT(ldr, last_ldr);
        EXPECT_GT(hdr, last_hdr);
        last_ldr = ldr, last_hdr = hdr;
    }
}

TEST(flip, fine_noise_fades_with_distance)
{
    const Jobs jobs;
    const Image a = scenery(64, 64, 7, 0.8f), b = scenery(64, 64, 8, 0.8f); // differ in noise alone
    FlipOptions near, far;
    near.ppd = 20.0f, far.ppd = 150.0f;
    EXPECT_GT(mean_of(flip_ldr(a, b, near, jobs)), 1.5 * mean_of(flip_ldr(a, b, far, jobs)));
}

TEST(flip, the_same_bits_for_every_thread_count_and_instruction_set)
{
    const Image a = scenery(530, 270, 9), b = scenery(530, 270, 10, 0.8f);
    const Image c = scenery(530, 270, 9, 30.0f), d = scenery(530, 270, 10, 25.0f);
    FlipOptions scalar;
    scalar.isa = Isa::scalar;
    const Image ldr = flip_ldr(a, b, scalar, Jobs(1)).error, hdr = flip_hdr(c, d, scalar, Jobs(1)).error;
    for (const Isa isa : isas_with<FlipFns>()) {
        FlipOptions options;
        options.isa = isa;
        for (const int threads : {1, 2, 5}) {
            const Jobs jobs(threads);
            EXPECT_EQ(flip_ldr(a, b, options, jobs).error.bytes, ldr.bytes) << isa_name(isa) << ", threads " << threads;
            EXPECT_EQ(flip_hdr(c, d, options, jobs).error.bytes, hdr.bytes) << isa_name(isa) << ", threads " << threads;
        }
    }
}

TEST(flip, one_pixel_is_a_picture)
{
    const Jobs jobs;
    const FlipResult result = flip_ldr(uniform(1, 1, 0, 0, 0), uniform(1, 1, 1, 1, 1), {}, jobs);
    EXPECT_GT(result.error.f32()[0], 0.9f);
    EXPECT_LE(result.error.f32()[0], 1.0f);
}

TEST(flip, eight_bits_sixteen_bits_and_linear_floats_agree)
{
    const Jobs jobs;
    std::mt19937 random(11);
    Image u8[2], u16[2], f32[2];
    for (int k = 0; k < 2; ++k) {
        u8[k] = make_image(60, 40, 3, PixelType::u8);
        u16[k] = make_image(60, 40, 3, PixelType::u16);
        f32[k] = make_image(60, 40, 3, PixelType::f32);
        for (std::size_t i = 0; i < u8[k].bytes.size(); ++i) {
            const std::uint8_t code = static_cast<std::uint8_t>(random());
            u8[k].bytes[i] = static_cast<std::byte>(code);
            reinterpret_cast<std::uint16_t*>(u16[k].bytes.data())[i] = static_cast<std::uint16_t>(code * 257);
            f32[k].f32()[i] = srgb_to_linear(static_cast<float>(code) / 255.0f);
        }
    }
    const Image error = flip_ldr(u8[0], u8[1], {}, jobs).error;
    EXPECT_EQ(flip_ldr(u16[0], u16[1], {}, jobs).error.bytes, error.bytes);
    EXPECT_EQ(flip_ldr(f32[0], f32[1], {}, jobs).error.bytes, error.bytes);
}

TEST(flip, gray_is_equal_channels_and_alpha_is_not_seen)
{
    const Jobs jobs;
    const Image colour[2] = {uniform(9, 9, 0.2f, 0.2f, 0.2f), uniform(9, 9, 0.6f, 0.6f, 0.6f)};
    Image gray[2], alpha[2];
    for (int k = 0; k < 2; ++k) {
        gray[k] = make_image(9, 9, 1, PixelType::f32);
        alpha[k] = make_image(9, 9, 4, PixelType::f32);
        for (std::size_t i = 0; i < 81; ++i) {
            gray[k].f32()[i] = colour[k].f32()[0];
            for (std::size_t c = 0; c < 3; ++c)
                alpha[k].f32()[4 * i + c] = colour[k].f32()[0];
            alpha[k].f32()[4 * i + 3] = static_cast<float>(k);
        }
    }
    const Image error = flip_ldr(colour[0], colour[1], {}, jobs).error;
    EXPECT_EQ(flip_ldr(gray[0], gray[1], {}, jobs).error.bytes, error.bytes);
    EXPECT_EQ(flip_ldr(alpha[0], alpha[1], {}, jobs).error.bytes, error.bytes);
}

// ACES: (0.9036 x^2 + 0.018 x) / (0.8748 x^2 + 0.354 x + 0.14) = 0.85 at x = 2.1189.
TEST(flip_exposures, run_from_the_largest_to_the_median_luminance)
{
    const Jobs jobs;
    Image image = uniform(3, 1, 2, 2, 2); // luminances 2, 8, 32
    for (std::size_t c = 0; c < 3; ++c)
        image.f32()[3 + c] = 8, image.f32()[6 + c] = 32;
    const FlipExposures range = find_exposures(image, {}, jobs);
    const double a = 0.36 * 2.51 - 0.85 * 0.36 * 2.43, b = 0.018 - 0.85 * 0.354, c = -0.85 * 0.14;
    const double x = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    EXPECT_NEAR(x, 2.1189, 1e-4);
    EXPECT_NEAR(range.start_ev, std::log2(x / 32), 1e-5);
    EXPECT_NEAR(range.stop_ev, std::log2(x / 8), 1e-5);
    EXPECT_EQ(range.count, 2); // ceil(2)
    FlipOptions reinhard;
    reinhard.tonemap = FlipTonemap::reinhard; // x / (1 + x) = 0.85
    EXPECT_NEAR(find_exposures(image, reinhard, jobs).start_ev, std::log2(0.85 / 0.15 / 32), 1e-5);
}

// Uses many pixels, including black and negative ones.
TEST(flip_exposures, median_is_that_of_the_sorted_lit_pixels)
{
    std::mt19937 random(21);
    for (const int lit : {1, 2, 5, 2000, 2501}) {
        Image image = uniform(53, 61, 0, 0, 0);
        std::vector<float> luminances;
        for (int i = 0; i < lit; ++i) {
            const float v = std::ldexp(static_cast<float>(random() % 4096 + 1), static_cast<int>(random() % 40) - 30);
            for (int c = 0; c < 3; ++c)
                image.f32()[3 * (i + 700) + c] = v;
            luminances.push_back(0.2126f * v + 0.7152f * v + 0.0722f * v);
        }
        image.f32()[0] = -5.0f;
        std::sort(luminances.begin(), luminances.end());
        for (const int threads : {1, 3}) {
            const FlipExposures range = find_exposures(image, {}, Jobs(threads));
            EXPECT_NEAR(range.start_ev, std::log2(2.11889 / static_cast<double>(luminances.back())), 1e-4) << lit;
            EXPECT_NEAR(range.stop_ev, std::log2(2.11889 / static_cast<double>(luminances[luminances.size() / 2])), 1e-4) << lit;
        }
    }
}

TEST(flip_exposures, count_is_one_a_stop)
{
    const Jobs jobs;
    Image image = uniform(3, 1, 1, 1, 1);
    image.f32()[6] = image.f32()[7] = image.f32()[8] = 90; // 6.49 stops above
    EXPECT_EQ(find_exposures(image, {}, jobs).count, 7);
    FlipOptions options;
    options.exposures = 3;
    EXPECT_EQ(find_exposures(image, options, jobs).count, 3);
    EXPECT_EQ(find_exposures(uniform(4, 4, 1, 1, 1), {}, jobs).count, 2);
}

TEST(flip_exposures, a_black_background_does_not_count)
{
    const Jobs jobs;
    const Image lit = scenery(40, 10, 12, 8.0f);
    Image framed = make_image(40, 40, 3, PixelType::f32); // three quarters are black
    std::copy_n(lit.f32(), lit.bytes.size() / 4, framed.f32());
    const FlipExposures alone = find_exposures(lit, {}, jobs), range = find_exposures(framed, {}, jobs);
    EXPECT_EQ(range.start_ev, alone.start_ev);
    EXPECT_EQ(range.stop_ev, alone.stop_ev);
    EXPECT_EQ(range.count, alone.count);
    const double mean = mean_of(flip_hdr(framed, shifted(framed, 0.5f), {}, jobs));
    EXPECT_TRUE(mean > 0.0 && mean <= 1.0) << mean;
}

TEST(flip_exposures, a_reference_without_light_still_compares)
{
    const Jobs jobs;
    const Image black = uniform(12, 12, 0, 0, 0);
    const FlipExposures range = find_exposures(black, {}, jobs);
    EXPECT_EQ(range.start_ev, 0.0f);
    EXPECT_EQ(range.stop_ev, 0.0f);
    EXPECT_EQ(mean_of(flip_hdr(black, black, {}, jobs)), 0.0);
    EXPECT_GT(mean_of(flip_hdr(black, uniform(12, 12, 1, 1, 1), {}, jobs)), 0.5);
}

TEST(flip_exposures, extremes_of_float_stay_finite)
{
    const Jobs jobs;
    for (const float v : {1e-44f, 1e-30f, 1e30f, 3e38f}) {
        const Image a = uniform(12, 12, v, v, v), b = uniform(12, 12, 0, 0, v);
        const FlipResult result = flip_hdr(a, b, {}, jobs);
        for (std::size_t i = 0; i < 144; ++i)
            ASSERT_TRUE(result.error.f32()[i] >= 0.0f && result.error.f32()[i] <= 1.0f) << v;
    }
}

TEST(flip_exposures, given_ones_are_taken)
{
    const Jobs jobs;
    const Image image = scenery(16, 16, 13, 4.0f);
    FlipOptions options;
    options.start_ev = -2.0f, options.stop_ev = 3.5f;
    const FlipExposures range = find_exposures(image, options, jobs);
    EXPECT_EQ(range.start_ev, -2.0f);
    EXPECT_EQ(range.stop_ev, 3.5f);
    EXPECT_EQ(range.count, 6);
    options.stop_ev.reset();
    options.start_ev = 50.0f; // beyond the stop found
    EXPECT_EQ(find_exposures(image, options, jobs).stop_ev, 50.0f);
}

// The largest exposure is a finite factor, since infinity times black would give NaN.
TEST(flip_exposures, black_stays_black_among_the_faintest_light)
{
    const Jobs jobs;
    Image a = uniform(12, 12, 1e-44f, 1e-44f, 1e-44f), b = a;
    for (std::size_t i = 0; i < 3 * 72; ++i)
        a.f32()[i] = 0.0f, b.f32()[i] = 1.0f;
    EXPECT_GT(largest_of(flip_hdr(a, b, {}, jobs)), 0.5);
}

// The range follows the brightness, so doubling the light in both images keeps the difference.
TEST(flip_hdr, brightness_of_both_pictures_does_not_matter)
{
    const Jobs jobs;
    const Image a = scenery(50, 50, 14), b = scenery(50, 50, 15), c = scenery(50, 50, 14, 4.0f), d = scenery(50, 50, 15, 4.0f);
    const FlipResult one = flip_hdr(a, b, {}, jobs), other = flip_hdr(c, d, {}, jobs);
    EXPECT_NEAR(other.exposures.start_ev, one.exposures.start_ev - 2.0f, 1e-5f);
    EXPECT_NEAR(mean_of(one), mean_of(other), 1e-5);
}

TEST(flip_hdr, is_the_largest_error_over_the_exposures)
{
    const Jobs jobs;
    const Image a = scenery(50, 50, 16, 10.0f), b = scenery(50, 50, 17, 10.0f);
    FlipOptions options;
    options.start_ev = -4.0f, options.stop_ev = 2.0f, options.exposures = 4; // -4, -2, 0, 2
    const Image all = flip_hdr(a, b, options, jobs).error;
    std::vector<float> largest(2500, 0.0f);
    for (const float ev : {-4.0f, -2.0f, 0.0f, 2.0f}) {
        FlipOptions one;
        one.start_ev = ev, one.stop_ev = ev, one.exposures = 1;
        const Image error = flip_hdr(a, b, one, jobs).error;
        for (std::size_t i = 0; i < largest.size(); ++i)
            largest[i] = std::max(largest[i], error.f32()[i]);
    }
    for (std::size_t i = 0; i < largest.size(); ++i)
        ASSERT_EQ(all.f32()[i], largest[i]);
}

TEST(flip_hdr, tonemapper_names_are_parsed)
{
    EXPECT_EQ(*parse_flip_tonemap("aces"), FlipTonemap::aces);
    EXPECT_EQ(*parse_flip_tonemap("reinhard"), FlipTonemap::reinhard);
    EXPECT_EQ(*parse_flip_tonemap("hable"), FlipTonemap::hable);
    EXPECT_FALSE(parse_flip_tonemap("none"));
}

} // namespace
} // namespace burnish
