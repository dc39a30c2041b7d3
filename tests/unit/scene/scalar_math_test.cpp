#include "core/math/scalar_math.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace burnish {
namespace {

// Returns the largest relative error against long double over evenly spaced arguments.
double worst(double from, double to, const std::function<double(double)>& ours, const std::function<long double(long double)>& exact)
{
    const int steps = 50000;
    double largest = 0.0;
    for (int i = 0; i <= steps; ++i) {
        const double x = from + (to - from) * i / steps;
        const long double want = exact(static_cast<long double>(x)), got = static_cast<long double>(ours(x));
        const long double error = std::fabs(got - want) / std::fmax(std::fabs(want), 1e-300L);
        largest = std::fmax(largest, got == want ? 0.0 : static_cast<double>(error));
    }
    return largest;
}

constexpr double kTight = 3e-16;

TEST(scalar_math, sine_and_cosine_keep_their_digits_also_near_their_zeros)
{
    EXPECT_LT(worst(-30.0, 30.0, det_sin, [](long double x) { return std::sin(x); }), kTight);
    EXPECT_LT(worst(-30.0, 30.0, det_cos, [](long double x) { return std::cos(x); }), kTight);
    EXPECT_LT(worst(1e5, 1.001e5, det_sin, [](long double x) { return std::sin(x); }), kTight);
    for (double x : {kPi, 2.0 * kPi, 10.0 * kPi, 1000.0 * kPi}) {
        const long double want = std::sin(static_cast<long double>(x));
        EXPECT_LT(std::fabs(static_cast<long double>(det_sin(x)) / want - 1.0L), 1e-15L) << x;
    }
    EXPECT_EQ(det_sin(0.0), 0.0);
    EXPECT_EQ(det_cos(0.0), 1.0);
}

TEST(scalar_math, exponential_and_logarithm_keep_their_digits)
{
    EXPECT_LT(worst(-700.0, 700.0, det_exp, [](long double x) { return std::exp(x); }), kTight);
    EXPECT_LT(worst(-1.0, 1.0, det_exp, [](long double x) { return std::exp(x); }), kTight);
    EXPECT_LT(worst(1e-3, 3.0, det_log, [](long double x) { return std::log(x); }), kTight);
    EXPECT_LT(worst(0.999, 1.001, det_log, [](long double x) { return std::log(x); }), kTight);
    EXPECT_LT(worst(1.0, 1e12, det_log, [](long double x) { return std::log(x); }), kTight);
    EXPECT_EQ(det_exp(0.0), 1.0);
    EXPECT_EQ(det_exp(-1000.0), 0.0);
    EXPECT_TRUE(std::isinf(det_exp(1000.0)));
    EXPECT_EQ(det_log(1.0), 0.0);
}

TEST(scalar_math, power_is_right_for_colours_and_roughness)
{
    for (double y : {0.25, 1.0 / 2.4, 2.0, 2.4, 5.0})
        EXPECT_LT(worst(
                      1e-3, 4.0, [y](double x) { return det_pow(x, y); },
                      [y](long double x) { return std::pow(x, static_cast<long double>(y)); }),
                  1e-14)
            << y;
    EXPECT_EQ(det_pow(0.0, 2.0), 0.0);
    EXPECT_EQ(det_pow(5.0, 0.0), 1.0);
}

TEST(scalar_math, inverse_functions_keep_their_digits)
{
    EXPECT_LT(worst(-20.0, 20.0, det_atan, [](long double x) { return std::atan(x); }), 1e-15);
    EXPECT_LT(worst(-1.0, 0.999, det_acos, [](long double x) { return std::acos(x); }), 1e-15);
    EXPECT_LT(worst(-1.0, 1.0, det_asin, [](long double x) { return std::asin(x); }), 1e-15);
    EXPECT_EQ(det_acos(2.0), 0.0);
    EXPECT_EQ(det_acos(-2.0), kPi);
}

TEST(scalar_math, atan2_knows_every_quadrant_and_axis)
{
    for (int i = 0; i < 360; ++i) {
        const double a = (i - 179.5) * kPi / 180.0;
        EXPECT_NEAR(det_atan2(3.0 * det_sin(a), 3.0 * det_cos(a)), a, 1e-15 * 4);
    }
    EXPECT_EQ(det_atan2(0.0, 1.0), 0.0);
    EXPECT_EQ(det_atan2(0.0, -1.0), kPi);
    EXPECT_EQ(det_atan2(2.0, 0.0), 0.5 * kPi);
    EXPECT_EQ(det_atan2(-2.0, 0.0), -0.5 * kPi);
    EXPECT_EQ(det_atan2(0.0, 0.0), 0.0);
}

} // namespace
} // namespace burnish
