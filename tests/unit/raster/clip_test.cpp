// Clipping against the clip planes in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "shading/kernels/clip.t.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr float kHalfWidth = 128.0f, kHalfHeight = 96.0f;

// Returns the smallest signed distance from the planes that clipping cuts at, in double precision; negative outside.
double least_distance(const ShadingFrame& f, const double c[4])
{
    const double gx = kCutBand / kSubpixel / static_cast<double>(kHalfWidth), gy = kCutBand / kSubpixel / static_cast<double>(kHalfHeight);
    const double before = f.view.orthographic ? 1.0 - c[3] : c[2] - static_cast<double>(f.view.znear);
    return std::fmin(before, std::fmin(std::fmin(gx * c[2] - c[0], gx * c[2] + c[0]), std::fmin(gy * c[2] - c[1], gy * c[2] + c[1])));
}

// Returns twice the area of (a, b, p), in barycentrics of the triangle.
double side(const clip_corner& a, const clip_corner& b, const double p[3])
{
    const double ax = a.bary[1], ay = a.bary[2], bx = b.bary[1], by = b.bary[2];
    return (bx - ax) * (p[2] - ay) - (by - ay) * (p[1] - ax);
}

TEST(clip, leaves_what_lies_inside_of_all_planes)
{
    for (const int orthographic : {0, 1}) {
        ShadingFrame f = {};
        f.half_width = kHalfWidth, f.half_height = kHalfHeight;
        f.view.znear = 0.125f, f.view.orthographic = orthographic;
        f.view.right[0] = f.view.up[1] = f.view.forward[2] = f.view.inv_tan_x = f.view.inv_tan_y = 1.0f;
        f.view.zfar = 2.0f, f.view.inv_depth = 1.0f; // so places are clip positions, or their depth is 2 - z
        Random random{17};
        int kept = 0, cut = 0, wrong = 0;
        double worst = 0.0;
        for (int k = 0; k < 4000; ++k) {
            float v[3][4];
            clip_polygon polygon;
            for (int i = 0; i < 3; ++i) {
                const float size = std::ldexp(1.0f, random.below(12));
                v[i][0] = (2.0f * random.unit() - 1.0f) * size, v[i][1] = (2.0f * random.unit() - 1.0f) * size;
                v[i][2] = orthographic ? 1.0f : 4.0f * random.unit() - 1.0f, v[i][3] = orthographic ? 2.0f * random.unit() : 0.125f;
                set_corner(f, polygon, i, v[i][0], v[i][1], orthographic ? 2.0f - v[i][3] : v[i][2]);
            }
            clip_triangle_to_frame(f, polygon);
            ASSERT_LE(polygon.count, 3 + kClipPlanes);
            double scale = 1.0;
            for (const auto& corner : v)
                for (const float c : corner)
                    scale = std::fmax(scale, std::fabs(static_cast<double>(c)));
            for (int i = 0; i < polygon.count; ++i) {
                const clip_corner& c = polygon.corner[i];
                for (int axis = 0; axis < 4; ++axis) {
                    double blend = 0.0;
                    for (int j = 0; j < 3; ++j)
                        blend += c.bary[j] * static_cast<double>(v[j][axis]);
                    worst = std::fmax(worst, std::fabs(blend - c.c[axis]) / scale);
                }
            }
            for (int n = 0; n < 30; ++n) {
                double b[3], c[4] = {0, 0, 0, 0};
                for (double& share : b)
                    share = static_cast<double>(random.unit());
                const double sum = b[0] + b[1] + b[2];
                for (int j = 0; j < 3; ++j) {
                    b[j] /= sum;
                    for (int axis = 0; axis < 4; ++axis)
                        c[axis] += b[j] * static_cast<double>(v[j][axis]);
                }
                const double distance = least_distance(f, c);
                if (std::fabs(distance) < 1e-9 * scale)
                    continue; // too near a cut
                bool inside = polygon.count >= 3;
                for (int i = 0; i < polygon.count; ++i)
                    inside = inside && side(polygon.corner[i], polygon.corner[(i + 1) % polygon.count], b) > -1e-9;
                wrong += inside != (distance > 0.0);
                ++(distance > 0.0 ? kept : cut);
            }
        }
        std::printf("%d points kept, %d cut off, %d wrongly; corners to %.2g\n", kept, cut, wrong, worst);
        EXPECT_GT(kept, 5000);
        EXPECT_GT(cut, 5000);
        EXPECT_EQ(wrong, 0);
        EXPECT_LT(worst, 1e-13);
    }
}

} // namespace
} // namespace burnish::test
