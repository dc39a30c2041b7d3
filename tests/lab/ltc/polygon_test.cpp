// Polygons under transformed cosines.
#include <gtest/gtest.h>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/lobe.h"
#include "shading/lab/ltc/polygon.h"

namespace burnish::ltc {
namespace {

constexpr Matrix kOne = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
const Matrix kSheared = inverse(Matrix{0.4, 0.05, -0.5, 0.02, 0.2, -0.2, 0.1, 0.05, 0.85});

// Returns the sides of a box around the shading point. Every direction meets one side.
std::vector<std::vector<Vec>> box(double low, double high)
{
    const auto p = [&](int x, int y, int z) { return Vec{x ? high : low, y ? high * 0.7 : low * 1.3, z ? high : low * 0.9}; };
    return {{p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)}, {p(0, 0, 0), p(1, 0, 0), p(1, 1, 0), p(0, 1, 0)},
            {p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)}, {p(0, 1, 0), p(1, 1, 0), p(1, 1, 1), p(0, 1, 1)},
            {p(0, 0, 0), p(0, 1, 0), p(0, 1, 1), p(0, 0, 1)}, {p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)}};
}

TEST(polygon, sides_of_a_box_take_the_whole_lobe)
{
    for (const Matrix& n : {kOne, kSheared}) {
        double sum = 0.0;
        for (const std::vector<Vec>& side : box(-1.0, 1.4))
            sum += polygon_part(n, side);
        EXPECT_NEAR(sum, 1.0, 1e-12);
    }
}

TEST(polygon, parts_sum_to_the_whole)
{
    const Vec a = {-0.6, -0.4, 0.3}, b = {0.5, -0.6, 0.2}, c = {0.4, 0.7, -0.2}, d = {-0.5, 0.6, 0.5};
    const auto mix = [](const Vec& u, const Vec& v, double t) {
        return Vec{u.x + t * (v.x - u.x), u.y + t * (v.y - u.y), u.z + t * (v.z - u.z)};
    };
    const Vec ab = mix(a, b, 0.3);
    for (const Matrix& n : {kOne, kSheared})
        EXPECT_NEAR(polygon_part(n, {a, ab, c}) + polygon_part(n, {ab, b, c}), polygon_part(n, {a, b, c}), 1e-12);
    EXPECT_GT(polygon_part(kOne, {a, b, d}), 0.05);
}

TEST(polygon, small_ones_are_density_times_solid_angle)
{
    const Vec at = {-0.5, -0.1, 0.8};
    const double side = 1e-4, distance2 = dot(at, at);
    const Vec normal = unit(at), x = unit(cross({0.0, 1.0, 0.0}, normal)), y = cross(normal, x);
    std::vector<Vec> quad;
    for (const auto& [s, t] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
        quad.push_back({at.x + side * (s * x.x + t * y.x), at.y + side * (s * x.y + t * y.y), at.z + side * (s * x.z + t * y.z)});
    for (const Matrix& n : {kOne, kSheared})
        EXPECT_NEAR(polygon_part(n, quad) / (transformed_cosine(n, normal) * 4.0 * side * side / distance2), 1.0, 1e-5);
}

TEST(polygon, below_the_horizon_there_is_nothing)
{
    EXPECT_EQ(polygon_part(kOne, {{1.0, 0.0, -0.2}, {0.0, 1.0, -0.3}, {-1.0, 0.0, 0.0}}), 0.0);
    EXPECT_NEAR(polygon_part(kOne, {{1e6, -1e6, 1.0}, {1e6, 1e6, 1.0}, {-1e6, 1e6, 1.0}, {-1e6, -1e6, 1.0}}), 1.0, 1e-5);
    EXPECT_EQ(polygon_part(kOne, {{0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}}), 0.0);
}

} // namespace
} // namespace burnish::ltc
