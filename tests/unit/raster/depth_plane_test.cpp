// The depth plane of a triangle, in double precision and in lanes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "shading/kernels/depth_plane.k.h"
#include "shading/lang/records.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

TEST(depth_plane, goes_through_the_vertices_and_is_the_same_by_lanes)
{
    Random random{23};
    double worst = 0.0;
    for (int k = 0; k < 20000; ++k) {
        const int size = 1 << (4 + random.below(18));
        int x[3], y[3];
        float z[3];
        for (int i = 0; i < 3; ++i)
            x[i] = random.below(2 * size) - size, y[i] = random.below(2 * size) - size, z[i] = random.unit();
        const double x10 = x[1] - x[0], y10 = y[1] - y[0], x20 = x[2] - x[0], y20 = y[2] - y[0], area = x10 * y20 - x20 * y10;
        if (std::fabs(area) < 0.05 * size * size)
            continue;
        const double z0 = static_cast<double>(z[0]), z10 = static_cast<double>(z[1]) - z0, z20 = static_cast<double>(z[2]) - z0;
        double right, down;
        depth_slopes(x10, y10, x20, y20, z10, z20, right, down);
        for (int i = 0; i < 3; ++i) {
            const double from_x = x[i] - x[0], from_y = y[i] - y[0];
            worst = std::fmax(worst, std::fabs(depth_at(z0, right, down, from_x, from_y) - static_cast<double>(z[i])));
        }
        wide wide_right, wide_down;
        depth_slopes(to_wide(x[1] - x[0]), to_wide(y[1] - y[0]), to_wide(x[2] - x[0]), to_wide(y[2] - y[0]), to_wide(z[1]) - to_wide(z[0]),
                     to_wide(z[2]) - to_wide(z[0]), wide_right, wide_down);
        EXPECT_EQ(wide_right.v, right);
        EXPECT_EQ(wide_down.v, down);
        EXPECT_EQ(depth_slope_by_pixel(right), right * kSubpixel);
    }
    std::printf("largest difference at a vertex: %.2g\n", worst);
    EXPECT_GT(worst, 0.0);
    EXPECT_LT(worst, 1e-13);
    EXPECT_EQ(depth_change(2.0f, 3.0f, 0.5f, 0.25f), 1.75f);
    EXPECT_EQ(depth_at_sample(0.25f, 0.5f, 0.0f, 1.0f), 0.75f);
    EXPECT_EQ(depth_at_sample(0.25f, 0.5f, 0.0f, 0.5f), 0.5f);
    EXPECT_EQ(depth_at_sample(0.25f, -0.5f, 0.125f, 0.5f), 0.125f);
}

} // namespace
} // namespace burnish::test
