// Perspective-correct interpolation against exact arithmetic.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "shading/kernels/interpolate.k.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

using quad = __float128; // 113 bits hold edge functions times a float exactly; one division rounds

TEST(interpolation, perspective_weights_equal_exact_arithmetic_within_float_rounding)
{
    Random random{21};
    double worst_fat = 0.0, worst_thin = 0.0; // relative to the triangle's condition number
    for (int k = 0; k < 200000; ++k) {
        const int size = 1 << (3 + random.below(17));
        float x[3], y[3], inv_w[3];
        for (int i = 0; i < 3; ++i) {
            x[i] = static_cast<float>(random.below(size) - size / 2);
            y[i] = static_cast<float>(random.below(size) - size / 2);
            inv_w[i] = std::ldexp(0.5f + random.unit(), -random.below(8));
        }
        quad e[3], sum = 0, scale = 0;
        bool inside = true;
        for (int i = 0; i < 3; ++i) {
            const int p = (i + 1) % 3, q = (i + 2) % 3;
            const quad a = static_cast<quad>(x[p]) * static_cast<quad>(y[q]), b = static_cast<quad>(x[q]) * static_cast<quad>(y[p]);
            e[i] = (a - b) * static_cast<quad>(inv_w[i]);
            inside = inside && a - b >= 0;
            sum += e[i];
            scale += ((a < 0 ? -a : a) + (b < 0 ? -b : b)) * static_cast<quad>(inv_w[i]);
        }
        if (!inside || sum <= 0)
            continue;
        const bary_weights w =
            perspective_weights(vec3_of(x[0], x[1], x[2]), vec3_of(y[0], y[1], y[2]), vec3_of(inv_w[0], inv_w[1], inv_w[2]));
        // the products' rounding error, scaled by the triangle's size
        const double condition = static_cast<double>(scale / sum);
        const float got[3] = {w.b.x, w.b.y, w.b.z};
        for (int i = 0; i < 3; ++i) {
            const double error = std::fabs(static_cast<double>(static_cast<quad>(got[i]) - e[i] / sum)) * 0x1p24 / condition;
            (condition < 4.0 ? worst_fat : worst_thin) = std::fmax(condition < 4.0 ? worst_fat : worst_thin, error);
        }
    }
    std::printf("largest error, in units of 2^-24 times the triangle's condition: %.2f well shaped, %.2f thin\n", worst_fat, worst_thin);
    EXPECT_GT(worst_fat, 0.0);
    EXPECT_LT(worst_fat, 4.0);
    EXPECT_LT(worst_thin, 4.0);
}

TEST(interpolation, corners_and_degenerate_triangles_are_safe)
{
    const bary_weights corner = perspective_weights(vec3_of(0, 512, 0), vec3_of(0, 0, 512), vec3_of(1, 0.5f, 0.25f));
    EXPECT_EQ(corner.b.x, 1.0f);
    EXPECT_EQ(corner.b.y, 0.0f);
    EXPECT_TRUE(corner.inside);
    const bary_weights flat = perspective_weights(vec3_of(5, 5, 5), vec3_of(3, 3, 3), vec3_of(1, 1, 1));
    EXPECT_TRUE(std::isfinite(flat.b.x) && std::isfinite(flat.b.y) && std::isfinite(flat.b.z));
}

} // namespace
} // namespace burnish::test
