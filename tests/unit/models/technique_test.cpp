// Parts of techniques against printed values and laws: filtered importance sampling, the lobe along its grain, tilted frames.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

std::vector<double> at(const char* name, const std::vector<double>& in)
{
    const std::vector<double> scalar = call(float_fns()[0], name, in);
    for (const IsaFns& isa : float_fns())
        EXPECT_EQ(call(isa, name, in), scalar) << name;
    return scalar;
}
double erfinv(double x)
{
    return call(float_fns()[0], "erfinv", {x})[0];
}

// View (sin 0.8, 0, cos 0.8), widths 0.4 and 0.1, a 5 x 5 grid, faces of 512^2 texels.
TEST(filtered_importance_sampling, equals_the_printed_test_vector)
{
    const double term = 0.5 * std::log2(6.0 * 512 * 512 / (4.0 * std::numbers::pi * 25));
    const auto sample = [&](int i, int j) {
        const double x = erfinv(2 * (i + .5) / 5 - 1), y = erfinv(2 * (j + .5) / 5 - 1);
        return at("filtered_beckmann", {std::sin(.8), 0, std::cos(.8), .4, .1, x, y, std::exp(-x * x - y * y) / std::numbers::pi, term});
    };
    const std::vector<double> a = sample(0, 2), b = sample(2, 2);
    EXPECT_NEAR(a[0], -.10431564, 2e-6);
    EXPECT_NEAR(a[1], 0, 1e-7);
    EXPECT_NEAR(a[2], .99454424, 2e-6);
    EXPECT_NEAR(a[3], 1.37322083, 1e-5);
    EXPECT_NEAR(a[4], 6.03098366, 1e-5);
    EXPECT_NEAR(b[0], -std::sin(.8), 1e-6) << "the middle sample is the mirror";
    EXPECT_NEAR(b[3], 1, 1e-5);
    EXPECT_NEAR(b[4], 5.38793674, 1e-5);
    double mean = 0;
    for (int i = 0; i < 25; ++i)
        mean += sample(i / 5, i % 5)[3] / 25;
    EXPECT_NEAR(mean, .93371920, 1e-5);
}

TEST(grain, points_where_the_extrema_point)
{
    for (double theta : {.1, .7, 1.4})
        for (double phi : {.2, 1.0, 2.5}) {
            const Vec o = direction(theta, phi);
            const std::vector<double> in = {o[0], o[1], o[2], .3, .05};
            const std::vector<double> t = at("grain_far", in);
            const double angle = at("far_angle", in)[0];
            EXPECT_NEAR(t[0] * std::sin(angle) - t[1] * std::cos(angle), 0, 2e-6);
            EXPECT_NEAR(t[0] * t[0] + t[1] * t[1], 1, 1e-6);
        }
}

// The middle sample mirrors the view about the normal, at the narrower width. A round lobe gives this one sample for every requested count.
TEST(grain, middle_samples_and_round_lobes_are_mirrors)
{
    const Vec o = direction(.5, .8);
    const double sigma = .1, root2 = std::numbers::sqrt2;
    const std::vector<double> middle = at("grain_sample", {o[0], o[1], o[2], .3, sigma, 1, 0, 1, .1});
    EXPECT_NEAR(middle[0], -o[0], 1e-6);
    EXPECT_NEAR(middle[1], -o[1], 1e-6);
    EXPECT_NEAR(middle[2], o[2], 1e-6);
    for (double c : {0.0, .6, -.9}) { // from the front: from the side even a round lobe is long
        const std::vector<double> g = at("grain_sample", {0, 0, 1, sigma, sigma, 1, c, std::sqrt(1 - c * c), .3});
        EXPECT_NEAR(g[0], 0, 1e-4) << c;
        EXPECT_NEAR(g[1], 0, 1e-4) << c;
        EXPECT_GT(g[2], 0) << c;
        if (c == 0.0) {
            EXPECT_NEAR(g[4], sigma * root2, 1e-6);
        }
    }
    EXPECT_EQ(at("grain_count", {0, 0, 1, sigma, sigma, 2.3, 16})[0], 1);
    EXPECT_GT(at("grain_count", {0, 0, 1, .3, .05, 2.3, 16})[0], at("grain_count", {0, 0, 1, .3, .1, 2.3, 16})[0]);
    EXPECT_EQ(at("grain_count", {0, 0, 1, .3, .001, 2.3, 16})[0], 16);
}

TEST(grain, degenerate_inputs_stay_finite)
{
    for (double z : {0.0, -.3, 1e-8, 1.0})
        for (double sx : {0.0, 1e-8, .3, .7})
            for (double sy : {0.0, 1e-8, .3})
                for (double c : {0.0, .95, -.9999}) {
                    const Vec o = unit({.6, 1e-8, z});
                    for (double v : at("grain_sample", {o[0], o[1], o[2], sx, sy, 1, c, std::sqrt(1 - c * c), .3}))
                        EXPECT_TRUE(std::isfinite(v)) << z << " " << sx << " " << sy << " " << c;
                }
}

// theta_x tilts the most common normal to +y, theta_y to -x.
TEST(tilt, turns_the_commonest_normal_as_the_ellipsoid_does)
{
    for (const auto& [x, y] : {std::pair{.2, 0.0}, {0.0, .2}, {.3, -.5}}) {
        const std::vector<double> n = at("tilted_normal", {x, y}), peak = at("ellipsoid_peak", {.3, .1, x, y, 0});
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(n[k], peak[k], 1e-6);
    }
    EXPECT_NEAR(at("tilted_normal", {.2, 0})[1], .19866933, 1e-6);
    EXPECT_NEAR(at("tilted_normal", {0, .2})[0], -.19866933, 1e-6);
}

} // namespace
} // namespace burnish::test
