#include <gtest/gtest.h>

#include <cmath>

#include "raster/reference/accumulator.h"

namespace burnish::test {
namespace {

TEST(accumulator, student_t_is_the_table_s)
{
    // Abramowitz and Stegun, table 26.10
    const std::pair<std::uint32_t, double> table[] = {{1, 12.706}, {4, 2.776},  {5, 2.571},  {7, 2.365},
                                                      {10, 2.228}, {30, 2.042}, {120, 1.980}};
    for (const auto& [degrees, t] : table)
        EXPECT_NEAR(student_t_975(degrees), t, 1.2e-3 * t) << degrees;
    EXPECT_TRUE(std::isinf(student_t_975(0)));
}

TEST(accumulator, blocks_cover_every_pixel_once)
{
    const Accumulator a(37, 21);
    std::vector<int> seen(37 * 21);
    for (std::size_t i = 0; i < a.passes.size(); ++i) {
        const PixelBlock b = block_of(a, i, 3);
        EXPECT_EQ(b.passes, 3u);
        for (int y = b.y0; y < b.y0 + b.height; ++y)
            for (int x = b.x0; x < b.x0 + b.width; ++x)
                ++seen[static_cast<std::size_t>(y * 37 + x)];
    }
    for (int n : seen)
        EXPECT_EQ(n, 1);
}

TEST(accumulator, variance_is_that_of_the_mean_and_its_interval_student_s)
{
    Accumulator a(1, 1);
    a.passes[0] = 5; // values 1 2 3 4 5: mean 3, squared differences 10
    for (int c = 0; c < 3; ++c)
        a.pixels[0].mean[c] = 3.0, a.pixels[0].m2[c] = 10.0;
    EXPECT_FLOAT_EQ(variance_image(a).f32()[1], 0.5f); // 10 / 4 / 5
    EXPECT_NEAR(mean_relative_error(a), 2.7764 * std::sqrt(0.5) / 3.0, 1e-4);
    a.passes[0] = 1;
    EXPECT_TRUE(std::isinf(mean_relative_error(a)));
    EXPECT_TRUE(std::isinf(variance_image(a).f32()[0]));
    a.pixels[0] = {};
    EXPECT_EQ(mean_relative_error(a), 0.0); // black pixels have no relative error
}

} // namespace
} // namespace burnish::test
