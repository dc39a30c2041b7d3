// Area light textures: exactly preserved values, and contents of blurred levels.
#include <gtest/gtest.h>

#include <cmath>

#include "core/image/image.h"
#include "core/simd/half.h"
#include "shading/bake/mip/light_picture.h"
#include "shading/lang/records.h"

namespace burnish::test {
namespace {

Image floats(int width, int height, float (*value)(int x, int y, int c))
{
    Image image = make_image(width, height, 3, PixelType::f32);
    auto* to = reinterpret_cast<float*>(image.bytes.data());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                *to++ = value(x, y, c);
    return image;
}

// Returns a texel; -1 is the border.
double texel_of_picture(const LightPicture& p, int level, int x, int y, int c)
{
    const auto stride = static_cast<std::size_t>(p.differences.level_width[level]) + 2;
    const std::size_t at =
        static_cast<std::size_t>(p.differences.offset[level]) + static_cast<std::size_t>(y + 1) * stride + static_cast<std::size_t>(x + 1);
    return static_cast<double>(half_to_float(p.differences.texels[4 * at + static_cast<std::size_t>(c)])) + static_cast<double>(p.mean[c]);
}

TEST(light_picture, of_one_colour_has_no_differences)
{
    for (const float level : {1.0f, 0.1f, 37.0f}) {
        Image image = floats(13, 6, [](int, int, int c) { return static_cast<float>(c + 1); });
        for (std::size_t i = 0; i < 13 * 6 * 3; ++i)
            reinterpret_cast<float*>(image.bytes.data())[i] *= level;
        const LightPicture p = make_light_picture(image);
        for (std::size_t i = 0; i < p.differences.texels.size(); ++i)
            ASSERT_TRUE(i % 4 == 3 || half_to_float(p.differences.texels[i]) == 0.0f) << i;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(p.mean[c] / (level * static_cast<float>(c + 1)), 1.0f, 5e-4f); // from half floats
    }
}

// White left of the middle. The levels' edges are blurred by kLightPictureSpread minus the later interpolation. Past the left edge, far
// from black, texels are white. The last level is the mean everywhere.
TEST(light_picture, levels_are_blurred_by_a_gaussian_of_what_lies_on_the_picture)
{
    const LightPicture p = make_light_picture(floats(256, 64, [](int x, int, int) { return x < 128 ? 1.0f : 0.0f; }));
    ASSERT_EQ(p.differences.levels, 9);
    const double spread = std::sqrt(static_cast<double>(kLightPictureSpread) * static_cast<double>(kLightPictureSpread) - 1.0 / 6.0);
    for (int level = 1; level <= 3; ++level) {
        const int width = 256 >> level, height = 64 >> level;
        for (int x = width / 2 - 3; x < width / 2 + 3; ++x) {
            const double z = (x + 0.5 - width / 2) / spread;
            for (const int y : {-1, 0, height / 2, height})
                EXPECT_NEAR(texel_of_picture(p, level, x, y, 0), 0.5 * std::erfc(z / std::sqrt(2.0)), 0.01)
                    << level << " " << x << " " << y;
        }
        EXPECT_NEAR(texel_of_picture(p, level, -1, 3, 1), 1.0, 1e-3);
        EXPECT_NEAR(texel_of_picture(p, level, width, 3, 1), 0.0, 1e-3);
    }
    for (int x = -1; x <= 1; ++x)
        EXPECT_NEAR(texel_of_picture(p, 8, x, 0, 2), 0.5, 1e-6);
}

} // namespace
} // namespace burnish::test
