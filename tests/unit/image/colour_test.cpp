#include "core/image/colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/image/tonemap_lanes.h"
#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"

namespace burnish {
namespace {

// The standard's formulas with the library's pow, as an oracle for the product.
double decode(double x)
{
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}
double encode(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

Image one_pixel(std::initializer_list<float> values)
{
    Image image = make_image(1, 1, static_cast<int>(values.size()), PixelType::f32);
    std::copy(values.begin(), values.end(), image.f32());
    return image;
}

std::vector<int> mapped(std::initializer_list<float> values, Tonemap tonemap = Tonemap::none, float ev = 0)
{
    std::vector<int> out;
    for (const std::byte b : tonemap_to_srgb8(one_pixel(values), tonemap, ev).bytes)
        out.push_back(static_cast<int>(b));
    return out;
}

TEST(colour, srgb_functions_are_correctly_rounded)
{
    for (int i = 0; i <= 4096; ++i) {
        const float x = static_cast<float>(i) / 4096.0f;
        EXPECT_FLOAT_EQ(srgb_to_linear(x), static_cast<float>(decode(static_cast<double>(x)))) << x;
        EXPECT_FLOAT_EQ(linear_to_srgb(x), static_cast<float>(encode(static_cast<double>(x)))) << x;
    }
    EXPECT_EQ(srgb_to_linear(0.0f), 0.0f);
    EXPECT_EQ(srgb_to_linear(1.0f), 1.0f);
    EXPECT_EQ(linear_to_srgb(1.0f), 1.0f);
    EXPECT_EQ(srgb_to_linear(-1.0f), 0.0f);
    EXPECT_EQ(srgb_to_linear(std::numeric_limits<float>::quiet_NaN()), 0.0f);
}

TEST(colour, every_srgb_code_survives_linear)
{
    for (int code = 0; code < 256; ++code) {
        const float linear = srgb_to_linear(static_cast<float>(code) / 255.0f);
        EXPECT_EQ(mapped({linear, linear, linear}), (std::vector<int>{code, code, code}));
    }
}

TEST(colour, eight_bit_srgb_is_exact_beside_every_boundary)
{
    for (int code = 1; code < 256; ++code) {
        const double boundary = decode((code - 0.5) / 255.0);
        const float near = static_cast<float>(boundary);
        const float below = static_cast<double>(near) < boundary ? near : std::nextafter(near, 0.0f);
        const float above = std::nextafter(below, 1.0f);
        EXPECT_EQ(mapped({below, above, 0}), (std::vector<int>{code - 1, code, 0}));
    }
    for (int i = 0; i <= 100000; ++i) {
        const float x = static_cast<float>(i) * 1.001e-5f;
        const int want = static_cast<int>(std::floor(255.0 * encode(std::min(1.0, static_cast<double>(x))) + 0.5));
        ASSERT_EQ(mapped({x, 0, 0})[0], want) << x;
    }
}

TEST(colour, strange_values_have_a_defined_code)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const Tonemap tonemap : {Tonemap::none, Tonemap::pbr_neutral, Tonemap::aces}) {
        EXPECT_EQ(mapped({nan, nan, nan, nan}, tonemap), (std::vector<int>{0, 0, 0, 0}));
        EXPECT_EQ(mapped({inf, inf, inf, inf}, tonemap), (std::vector<int>{255, 255, 255, 255}));
        EXPECT_EQ(mapped({-inf, -1, -0.0f, -1}, tonemap), (std::vector<int>{0, 0, 0, 0}));
    }
    EXPECT_EQ(mapped({inf, nan, -inf}), (std::vector<int>{255, 0, 0}));
    EXPECT_EQ(mapped({1e-42f, 3e38f, 1.0f}), (std::vector<int>{0, 255, 255}));
}

TEST(colour, alpha_is_linear_and_gray_stays_gray)
{
    EXPECT_EQ(mapped({0, 0, 0, 0.5f}, Tonemap::aces, 3.0f)[3], 128);
    EXPECT_EQ(mapped({0.5f}), (std::vector<int>{188}));
    EXPECT_EQ(mapped({0.5f, 0.25f}), (std::vector<int>{188, 64}));
}

TEST(colour, exposure_is_in_stops)
{
    EXPECT_EQ(mapped({0.125f, 0.125f, 0.125f}, Tonemap::none, 2.0f), mapped({0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(mapped({2.0f, 2.0f, 2.0f}, Tonemap::none, -2.0f), mapped({0.5f, 0.5f, 0.5f}));
    const float root = std::sqrt(0.5f);
    EXPECT_EQ(mapped({1, 1, 1}, Tonemap::none, -0.5f), mapped({root, root, root}));
}

int code(double linear)
{
    return static_cast<int>(std::floor(255.0 * encode(std::clamp(linear, 0.0, 1.0)) + 0.5));
}

// Gray x: offset 0.04, compressed above 0.76 to 1 - 0.24^2 / (x - 0.04 + 0.24 - 0.76).
TEST(colour, pbr_neutral_follows_its_specification)
{
    EXPECT_EQ(mapped({0.5f, 0.5f, 0.5f}, Tonemap::pbr_neutral), std::vector<int>(3, code(0.46)));
    EXPECT_EQ(mapped({0.04f, 0.04f, 0.04f}, Tonemap::pbr_neutral), std::vector<int>(3, code(6.25 * 0.0016)));
    EXPECT_EQ(mapped({2, 2, 2}, Tonemap::pbr_neutral), std::vector<int>(3, code(1 - 0.0576 / 1.44)));
    // Red 4 in a coloured light: peak 3.96, new peak 1 - 0.0576 / 3.44, mixed with white by the loss.
    const double peak = 4 - 0.04, low = 0.5 - 0.04, top = 1 - 0.0576 / (peak + 0.24 - 0.76);
    const double white = 1 - 1 / (0.15 * (peak - top) + 1);
    EXPECT_EQ(mapped({4, 0.5f, 0.5f}, Tonemap::pbr_neutral),
              (std::vector<int>{code(top), code(low * top / peak * (1 - white) + top * white),
                                code(low * top / peak * (1 - white) + top * white)}));
}

// Gray in, gray out (the matrices' rows sum to one within 1e-4): the curve alone decides.
TEST(colour, aces_follows_hills_fit)
{
    for (const double x : {0.02, 0.18, 1.0, 5.0}) {
        const double y = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
        const float f = static_cast<float>(x);
        for (const int value : mapped({f, f, f}, Tonemap::aces))
            EXPECT_NEAR(value, code(y), 1) << x;
    }
    // Pure red, by hand: the input matrix' first column, the curve, the output matrix.
    const auto fit = [](double v) { return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081); };
    const double r = fit(0.59719), g = fit(0.07600), b = fit(0.02840);
    EXPECT_EQ(mapped({1, 0, 0}, Tonemap::aces),
              (std::vector<int>{code(1.60475 * r - 0.53108 * g - 0.07367 * b), code(-0.10208 * r + 1.10813 * g - 0.00605 * b),
                                code(-0.00327 * r - 0.07276 * g + 1.07602 * b)}));
}

TEST(colour, tonemap_names_are_parsed)
{
    EXPECT_EQ(*parse_tonemap("none"), Tonemap::none);
    EXPECT_EQ(*parse_tonemap("pbr-neutral"), Tonemap::pbr_neutral);
    EXPECT_EQ(*parse_tonemap("aces"), Tonemap::aces);
    const Result<Tonemap> wrong = parse_tonemap("filmic");
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, ExitCode::usage);
}

// An edge between white and black, half a pixel each. Averaged linearly the pixel has half the light; averaged on display, half the white
// value.
TEST(colour, parts_of_a_pixel_are_tonemapped_before_they_are_averaged)
{
    const float kBright = 100.0f;
    const auto shown = [&](std::initializer_list<float> pixel, bool background) {
        const std::vector<PixelPart> parts = {pixel_part(0, 0b0011, false, {kBright, kBright, kBright}),
                                              pixel_part(0, 0b1100, background, {0.0f, 0.0f, 0.0f})};
        return tonemap_to_srgb8(one_pixel(pixel), Tonemap::none, 0.0f, parts, Resolve::display);
    };
    EXPECT_EQ(mapped({kBright / 2, kBright / 2, kBright / 2}), (std::vector<int>{255, 255, 255}));
    EXPECT_EQ(static_cast<int>(shown({kBright / 2, kBright / 2, kBright / 2}, true).bytes[0]), mapped({0.5f})[0]);
    const Image covered = shown({kBright, kBright, kBright, 0.5f}, true); // with alpha: nothing lies behind
    EXPECT_EQ(static_cast<int>(covered.bytes[0]), 255);
    EXPECT_EQ(static_cast<int>(covered.bytes[3]), 128);
    EXPECT_EQ(static_cast<int>(shown({kBright, kBright, kBright, 1.0f}, false).bytes[0]), mapped({0.5f})[0]);
}

// Two samples show a white sheet of alpha .25, two show nothing; then one sample shows an opaque surface. Colours of parts are multiplied
// by alpha, colours of 8-bit pictures are not.
TEST(colour, parts_that_shine_through_keep_their_colour)
{
    for (const Resolve resolve : {Resolve::display, Resolve::weighted}) {
        const auto shown = [&](const std::vector<PixelPart>& parts, float alpha) {
            const Image pixel = tonemap_to_srgb8(one_pixel({1.0f, 1.0f, 1.0f, alpha}), Tonemap::none, 0.0f, parts, resolve);
            return std::pair(static_cast<int>(pixel.bytes[0]), static_cast<int>(pixel.bytes[3]));
        };
        const PixelPart sheet = pixel_part(0, 0b0011, false, {0.25f, 0.25f, 0.25f}, 0.25f);
        EXPECT_EQ(shown({sheet, pixel_part(0, 0b1100, true, {0.0f, 0.0f, 0.0f})}, 0.125f), std::pair(255, 32));
        EXPECT_EQ(shown({sheet, pixel_part(0, 0b1100, false, {1.0f, 1.0f, 1.0f})}, 0.625f), std::pair(255, 159));
    }
    // A black part hides four times as much as the sheet
    const std::vector<PixelPart> parts = {pixel_part(0, 0b0011, false, {0.25f, 0.25f, 0.25f}, 0.25f),
                                          pixel_part(0, 0b1100, false, {0.0f, 0.0f, 0.0f})};
    const Image pixel = tonemap_to_srgb8(one_pixel({0.2f, 0.2f, 0.2f, 0.625f}), Tonemap::none, 0.0f, parts, Resolve::display);
    EXPECT_EQ(static_cast<int>(pixel.bytes[0]), mapped({0.2f})[0]);
}

// Half of 100, half of 0: their weights are 1 / 101 and 1, and the mean 100 / 102. At two stops less, 25 weighs 1 / 26.
TEST(colour, bright_parts_of_a_pixel_weigh_less)
{
    const std::vector<PixelPart> parts = {pixel_part(0, 0b0011, false, {100.0f, 100.0f, 100.0f}),
                                          pixel_part(0, 0b1100, false, {0.0f, 0.0f, 0.0f})};
    const Image pixel = one_pixel({50.0f, 50.0f, 50.0f});
    const auto code = [&](float exposure_ev, Resolve resolve) {
        return static_cast<int>(tonemap_to_srgb8(pixel, Tonemap::none, exposure_ev, parts, resolve).bytes[0]);
    };
    EXPECT_EQ(code(0.0f, Resolve::linear), 255);
    EXPECT_EQ(code(0.0f, Resolve::weighted), mapped({100.0f / 102.0f})[0]);
    EXPECT_EQ(code(-2.0f, Resolve::weighted), mapped({25.0f / 27.0f})[0]);
    EXPECT_EQ(code(-8.0f, Resolve::weighted), mapped({0.390625f / 2.390625f})[0]);
}

// Pixels whose parts lie in two ranges of the loop, and pixels without parts, among them.
TEST(resolve, gives_the_same_bytes_on_all_threads)
{
    for (const int channels : {3, 4}) {
        Image image = make_image(500, 300, channels, PixelType::f32);
        const std::size_t pixels = 500 * 300;
        for (std::size_t i = 0; i < pixels * static_cast<std::size_t>(channels); ++i)
            image.f32()[i] = static_cast<float>(i * 2654435761u % 4096) / 1024.0f;
        std::vector<PixelPart> parts;
        for (std::uint32_t p = 0; p < pixels; p += 1 + p % 3)
            for (std::uint32_t k = 0; k < 2 + p % 4; ++k)
                parts.push_back(pixel_part(p, 1u << k, false, {static_cast<float>(p % 97) * 0.1f, static_cast<float>(k), 0.5f}, 0.5f));
        for (const Resolve resolve : {Resolve::linear, Resolve::display, Resolve::weighted}) {
            const Image wanted = tonemap_to_srgb8(image, Tonemap::pbr_neutral, 0.5f, parts, resolve);
            for (const int threads : {1, 2, 3, 7}) {
                const Jobs jobs(threads);
                EXPECT_EQ(tonemap_to_srgb8(image, Tonemap::pbr_neutral, 0.5f, parts, resolve, &jobs).bytes, wanted.bytes) << threads;
            }
        }
    }
}

// More pixels than one range of the loop has.
TEST(tonemap, shows_grays_as_colours_of_three_equal_channels)
{
    constexpr int kWidth = 331, kHeight = 257;
    Image colours = make_image(kWidth, kHeight, 3, PixelType::f32), gray = make_image(kWidth, kHeight, 1, PixelType::f32);
    Image with_alpha = make_image(kWidth, kHeight, 2, PixelType::f32);
    for (std::size_t i = 0; i < std::size_t{kWidth} * kHeight; ++i) {
        const float value = static_cast<float>(i * 2654435761u % 4096) / 1024.0f;
        std::fill_n(colours.f32() + 3 * i, 3, value);
        gray.f32()[i] = with_alpha.f32()[2 * i] = value, with_alpha.f32()[2 * i + 1] = 0.25f;
    }
    const Jobs jobs(3);
    for (const Tonemap tonemap : {Tonemap::none, Tonemap::pbr_neutral}) {
        const Image wanted = tonemap_to_srgb8(colours, tonemap, 0.5f);
        for (const Jobs* threads : {static_cast<const Jobs*>(nullptr), &jobs}) {
            const Image a = tonemap_to_srgb8(gray, tonemap, 0.5f, threads), b = tonemap_to_srgb8(with_alpha, tonemap, 0.5f, threads);
            for (std::size_t i = 0; i < a.bytes.size(); ++i)
                ASSERT_TRUE(a.bytes[i] == wanted.bytes[3 * i] && b.bytes[2 * i] == a.bytes[i] && b.bytes[2 * i + 1] == std::byte{64}) << i;
        }
    }
}

TEST(tonemap, gives_the_same_bytes_by_every_instruction_set)
{
    // Every magnitude, both signs, and numbers that are not finite, in a count that fills no whole registers
    constexpr std::size_t kPixels = 4099;
    const float special[] = {0.0f, -0.0f, std::nanf(""), INFINITY, -INFINITY, 1e30f, -1.0f, 1e-40f, 1.0f, 0.76f, 0.08f};
    std::vector<float> pixels(4 * kPixels);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = i % 5 == 0 ? special[i / 5 % std::size(special)]
                               : std::ldexp(1.0f + static_cast<float>(i * 2654435761u % 4096) / 4096.0f, static_cast<int>(i % 40) - 25);
    // Boundaries that rise, with a first candidate of 0 for all
    std::vector<float> least(257);
    for (std::size_t code = 0; code < 256; ++code)
        least[code] = static_cast<float>(code * code) / 65025.0f;
    least[256] = 2.0f;
    constexpr std::int32_t kFirstKey = 0x3700, kLastKey = 0x3F80;
    const std::vector<std::int32_t> start(kLastKey - kFirstKey + 1, 0);
    const tone::CodeTable table = {kFirstKey, start.data(), least.data()};
    for (const tone::Curve curve : {tone::Curve::none, tone::Curve::pbr_neutral, tone::Curve::aces})
        for (const int channels : {3, 4}) {
            const auto bytes_by = [&](Isa isa) {
                std::vector<std::uint8_t> bytes(static_cast<std::size_t>(channels) * kPixels + 1, 77);
                pick<tone::Fns>(isa).pixels({curve, 1.5f, table, channels, kPixels, pixels.data(), bytes.data()});
                return bytes;
            };
            const std::vector<std::uint8_t> wanted = bytes_by(Isa::scalar);
            EXPECT_EQ(wanted.back(), 77) << "the byte after the last pixel";
            for (const Isa isa : isas_with<tone::Fns>())
                EXPECT_EQ(bytes_by(isa), wanted) << isa_name(isa) << ", channels " << channels;
        }
}

} // namespace
} // namespace burnish
