#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/image/colour.h"
#include "core/simd/dispatch.h"
#include "core/simd/half.h"
#include "shading/bake/mip/map_levels.h"
#include "shading/bake/mip/texture.h"
#include "shading/bake/mip/texture_rows.h"
#include "tests/unit/bake/bake_test.h"

namespace burnish {
namespace {

float texel(const TexturePyramid& p, int level, int x, int y, int c) // x, y: -1 is the border
{
    const int stride = static_cast<int>(p.level_width[level]) + 2;
    return half_to_float(p.texels[static_cast<std::size_t>(4 * (p.offset[level] + (y + 1) * stride + x + 1) + c)]);
}

Image random_image(int width, int height, int channels, PixelType type)
{
    Image image = make_image(width, height, channels, type);
    Random random(static_cast<std::uint64_t>(width * 1000 + height * 10 + channels));
    for (std::size_t i = 0; i < image.bytes.size() / pixel_type_bytes(type); ++i) {
        const double v = random();
        if (type == PixelType::u8)
            reinterpret_cast<std::uint8_t*>(image.bytes.data())[i] = static_cast<std::uint8_t>(v * 255.99);
        else if (type == PixelType::u16)
            reinterpret_cast<std::uint16_t*>(image.bytes.data())[i] = static_cast<std::uint16_t>(v * 65535.99);
        else
            image.f32()[i] = static_cast<float>(v * 4.0);
    }
    return image;
}

// Returns decoded channel c in [0,4) of a pixel, in double precision.
double decoded(const Image& image, bool srgb, int x, int y, int c)
{
    const int n = image.channels;
    if (c == 3 && (n == 1 || n == 3))
        return 1.0;
    const std::size_t at = static_cast<std::size_t>((y * image.width + x) * n + (c == 3 ? n - 1 : n >= 3 ? c : 0));
    if (image.type == PixelType::f32)
        return static_cast<double>(image.f32()[at]);
    const double v = image.type == PixelType::u8 ? reinterpret_cast<const std::uint8_t*>(image.bytes.data())[at] / 255.0
                                                 : reinterpret_cast<const std::uint16_t*>(image.bytes.data())[at] / 65535.0;
    if (!srgb || c == 3)
        return v;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// Returns the mean over the footprint of texel (x, y) in a w x h level, by area.
double naive_box(const Image& image, bool srgb, int w, int h, int x, int y, int c)
{
    double sum = 0.0;
    const double x0 = static_cast<double>(x) * image.width / w, x1 = static_cast<double>(x + 1) * image.width / w;
    const double y0 = static_cast<double>(y) * image.height / h, y1 = static_cast<double>(y + 1) * image.height / h;
    for (int j = 0; j < image.height; ++j)
        for (int i = 0; i < image.width; ++i) {
            const double ox = std::min(x1, i + 1.0) - std::max(x0, i + 0.0);
            const double oy = std::min(y1, j + 1.0) - std::max(y0, j + 0.0);
            if (ox > 0.0 && oy > 0.0)
                sum += ox * oy * decoded(image, srgb, i, j, c);
        }
    return sum / ((x1 - x0) * (y1 - y0));
}

struct Case {
    int width, height, channels;
    PixelType type;
    TextureEncoding encoding;
};

class texture_pyramid_of : public testing::TestWithParam<Case> {};

TEST_P(texture_pyramid_of, every_level_is_the_exact_box_filter_of_level_zero)
{
    const Case k = GetParam();
    const Image image = random_image(k.width, k.height, k.channels, k.type);
    const bool srgb = k.encoding == TextureEncoding::srgb;
    const TexturePyramid p = make_texture_pyramid(image, {}, k.encoding);
    ASSERT_EQ(p.levels, 1 + static_cast<int>(std::floor(std::log2(std::max(k.width, k.height)))));
    for (int l = 0; l < p.levels; ++l) {
        const int w = std::max(1, k.width >> l), h = std::max(1, k.height >> l);
        ASSERT_EQ(p.level_width[l], static_cast<float>(w));
        ASSERT_EQ(p.level_height[l], static_cast<float>(h));
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                for (int c = 0; c < 4; ++c) {
                    const double expected = naive_box(image, srgb, w, h, x, y, c);
                    // half an ulp of a half, and a margin for float
                    ASSERT_NEAR(static_cast<double>(texel(p, l, x, y, c)), expected, expected * 0x1.01p-11 + 1e-7)
                        << "level " << l << " at " << x << "," << y << " channel " << c;
                }
    }
}

INSTANTIATE_TEST_SUITE_P(
    sizes, texture_pyramid_of,
    testing::Values(Case{16, 16, 4, PixelType::u8, TextureEncoding::srgb}, Case{13, 7, 3, PixelType::u8, TextureEncoding::srgb},
                    Case{12, 20, 4, PixelType::u8, TextureEncoding::linear}, Case{31, 33, 1, PixelType::u8, TextureEncoding::linear},
                    Case{17, 2, 2, PixelType::u16, TextureEncoding::srgb}, Case{1, 9, 3, PixelType::u16, TextureEncoding::linear},
                    Case{24, 6, 4, PixelType::f32, TextureEncoding::linear}, Case{1, 1, 1, PixelType::u8, TextureEncoding::srgb}));

TEST(texture_pyramid, mean_of_every_level_of_a_power_of_two_image_is_the_mean_of_the_image)
{
    const Image image = random_image(64, 32, 3, PixelType::u8);
    const TexturePyramid p = make_texture_pyramid(image, {}, TextureEncoding::srgb);
    const double mean = naive_box(image, true, 1, 1, 0, 0, 1);
    for (int l = 0; l < p.levels; ++l) {
        const int w = static_cast<int>(p.level_width[l]), h = static_cast<int>(p.level_height[l]);
        double sum = 0.0;
        for (int i = 0; i < w * h; ++i)
            sum += static_cast<double>(texel(p, l, i % w, i / w, 1));
        EXPECT_NEAR(sum / (w * h), mean, mean * 5e-4) << "level " << l;
    }
}

TEST(texture_pyramid, decodes_every_srgb_code_to_the_nearest_half)
{
    Image image = make_image(256, 1, 1, PixelType::u8);
    for (int i = 0; i < 256; ++i)
        image.bytes[static_cast<std::size_t>(i)] = static_cast<std::byte>(i);
    const TexturePyramid p = make_texture_pyramid(image, {}, TextureEncoding::srgb);
    for (int i = 0; i < 256; ++i)
        EXPECT_EQ(texel(p, 0, i, 0, 0), half_to_float(float_to_half(srgb_to_linear(static_cast<float>(i) / 255.0f)))) << i;
}

TEST(texture_pyramid, borders_follow_the_wrap_mode_of_their_axis)
{
    const Image image = random_image(12, 5, 4, PixelType::u8);
    const WrapMode modes[] = {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror};
    for (const WrapMode s : modes)
        for (const WrapMode t : modes) {
            Texture sampler;
            sampler.wrap_s = s, sampler.wrap_t = t;
            const TexturePyramid p = make_texture_pyramid(image, sampler, TextureEncoding::linear);
            const auto wrapped = [](WrapMode mode, int i, int n) {
                return mode == WrapMode::repeat ? (i + n) % n : std::clamp(i, 0, n - 1); // mirroring repeats the edge texel
            };
            for (int l = 0; l < p.levels; ++l) {
                const int w = static_cast<int>(p.level_width[l]), h = static_cast<int>(p.level_height[l]);
                for (int y = -1; y <= h; ++y)
                    for (int x = -1; x <= w; ++x)
                        ASSERT_EQ(texel(p, l, x, y, 2), texel(p, l, wrapped(s, x, w), wrapped(t, y, h), 2));
            }
        }
}

TEST(texture_pyramid, nan_and_infinity_of_float_images_do_not_spread)
{
    Image image = make_image(4, 4, 3, PixelType::f32);
    std::fill(image.f32(), image.f32() + 48, 1.0f);
    image.f32()[0] = NAN;
    image.f32()[1] = INFINITY;
    const TexturePyramid p = make_texture_pyramid(image, {}, TextureEncoding::linear);
    EXPECT_EQ(texel(p, 0, 0, 0, 0), 0.0f);
    EXPECT_EQ(texel(p, 0, 0, 0, 1), 65504.0f);
    EXPECT_EQ(texel(p, 2, 0, 0, 0), 0.9375f);
    for (std::size_t i = 0; i < p.texels.size(); ++i)
        ASSERT_TRUE(std::isfinite(half_to_float(p.texels[i])));
}

TEST(texture_pyramid, of_levels_that_were_kept_is_the_same)
{
    for (const PixelType type : {PixelType::u8, PixelType::u16, PixelType::f32})
        for (int channels = 1; channels <= 4; ++channels)
            for (const auto& [width, height] : {std::pair(13, 6), {1, 9}, {1, 1}, {8, 8}})
                for (const MapPart part : {MapPart::base_color, MapPart::metallic_roughness, MapPart::height}) {
                    const Image image = random_image(width, height, channels, type);
                    const Texture sampler = {"", 0, WrapMode::mirror, WrapMode::clamp};
                    const TexturePyramid own = make_texture_pyramid(image, sampler, encoding_of(part));
                    const MapLevels levels = make_map_levels(image, sampler, {part, ColourKernel::box, 0, 0}, nullptr, Jobs(1));
                    const TexturePyramid kept = pyramid_of_map(image, sampler, levels);
                    const std::size_t first = part == MapPart::height ? 3 : 0; // height maps need no other channel
                    ASSERT_EQ(own.texels.size(), kept.texels.size());
                    for (std::size_t i = 0; i < own.texels.size(); ++i)
                        if (i % 4 >= first) {
                            ASSERT_EQ(own.texels[i], kept.texels[i]) << width << "x" << height << " of " << channels << " at " << i;
                        }
                    EXPECT_EQ(own.wrap_s, kept.wrap_s);
                }
}

// Weighted by a constant, the means nearly equal unweighted means, for every thread count.
TEST(texture_pyramid, of_weighted_levels_does_not_depend_on_threads)
{
    const Image image = random_image(29, 17, 3, PixelType::u8);
    Image facing = make_image(29, 17, 1, PixelType::f32);
    std::fill_n(facing.f32(), 29 * 17, 0.25f);
    const MapId id = {MapPart::base_color, ColourKernel::box, 0, 1};
    const MapLevels even = make_map_levels(image, {}, id, &facing, Jobs(1)), plain = make_map_levels(image, {}, id, nullptr, Jobs(1));
    for (std::size_t l = 0; l < plain.levels.size(); ++l)
        for (std::size_t i = 0; i < plain.levels[l].size(); ++i)
            ASSERT_NEAR(half_to_float(even.levels[l][i]), half_to_float(plain.levels[l][i]), 5e-4f);
    Random random(5);
    for (int i = 0; i < 29 * 17; ++i)
        facing.f32()[i] = static_cast<float>(0.01 + random());
    for (const ColourKernel kernel : {ColourKernel::box, ColourKernel::kaiser}) {
        const MapId of = {MapPart::base_color, kernel, 0, 1};
        EXPECT_EQ(make_map_levels(image, {}, of, &facing, Jobs(1)).levels, make_map_levels(image, {}, of, &facing, Jobs(3)).levels);
    }
}

TEST(texture_rows, are_halved_and_rounded_alike_by_every_instruction_set)
{
    constexpr std::size_t kTexels = 37;
    std::vector<float> top(8 * kTexels), bottom(8 * kTexels);
    for (std::size_t i = 0; i < top.size(); ++i) {
        const auto number = [&](std::size_t k) {
            return static_cast<float>(k * 2654435761u % 8191 + 1) * std::ldexp(1.0f, static_cast<int>(k % 40) - 30);
        };
        top[i] = number(2 * i), bottom[i] = i % 3 ? -number(2 * i + 1) : number(2 * i + 1);
    }
    for (const Isa isa : isas_with<mip::TextureFns>()) {
        const mip::TextureFns& fns = pick<mip::TextureFns>(isa);
        std::vector<float> made(4 * kTexels);
        fns.halve({top.data(), bottom.data(), kTexels, made.data()});
        std::vector<std::uint16_t> halves(made.size()), rests(made.size());
        fns.halves({made.data(), made.size(), false, halves.data()});
        fns.halves({made.data(), made.size(), true, rests.data()});
        for (std::size_t i = 0; i < kTexels; ++i)
            for (std::size_t c = 0; c < 4; ++c) {
                const auto column = [&](std::size_t k) { return 0.5 * static_cast<double>(top[k]) + 0.5 * static_cast<double>(bottom[k]); };
                const float wanted = static_cast<float>(0.5 * column(8 * i + c) + 0.5 * column(8 * i + 4 + c));
                EXPECT_EQ(made[4 * i + c], wanted) << isa_name(isa);
                EXPECT_EQ(halves[4 * i + c], float_to_half(wanted)) << isa_name(isa);
                EXPECT_EQ(rests[4 * i + c], float_to_half(wanted - half_to_float(float_to_half(wanted)))) << isa_name(isa);
            }
    }
}

} // namespace
} // namespace burnish
