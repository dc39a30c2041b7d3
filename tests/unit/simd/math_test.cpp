// Errors of the math kernels against double libm: the float versions (all equal, see ops_test.cpp) and the double oracle.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "tests/unit/lanes/kernels.h"

namespace burnish {
namespace {

enum class Measure { ulp, absolute, relative };

double error_of(Measure measure, double got, double want)
{
    const double difference = std::fabs(got - want);
    if (measure == Measure::absolute)
        return difference;
    if (measure == Measure::relative)
        return difference / std::fabs(want);
    const float magnitude = std::fabs(static_cast<float>(want));
    const float ulp = std::nextafter(magnitude, INFINITY) - magnitude;
    return difference / static_cast<double>(ulp);
}

struct Points {
    std::vector<float> a, b;
};

struct MathCase {
    const char* kernel;
    Measure measure;
    double limit;        // for the float version
    double oracle_limit; // for the double version: the fit's absolute or relative error
    std::function<double(double, double)> want;
    Points points;
};

void check(MathCase c)
{
    const std::size_t n = c.points.a.size();
    c.points.b.resize(n);
    std::vector<double> in(c.points.a.begin(), c.points.a.end());
    in.insert(in.end(), c.points.b.begin(), c.points.b.end());
    const std::vector<double> got = test::call(test::fast_fns(), c.kernel, in), oracle = test::call(test::oracle_fns(), c.kernel, in);
    double worst = 0.0, worst_oracle = 0.0, worst_a = 0.0, worst_b = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        const double want = c.want(in[k], in[n + k]);
        const double error = want == 0.0 ? std::fabs(got[k]) : error_of(c.measure, got[k], want);
        if (!(error <= worst))
            worst = error, worst_a = in[k], worst_b = in[n + k];
        const Measure fit = c.measure == Measure::absolute || std::fabs(want) < 1.0 ? Measure::absolute : Measure::relative;
        worst_oracle = std::max(worst_oracle, want == 0.0 ? 0.0 : error_of(fit, oracle[k], want));
    }
    const char* units[] = {"ulp", "absolute", "relative"};
    std::printf("%-6s largest error %.3g %s at (%.9g, %.9g) of %zu points; double version %.2g\n", c.kernel, worst,
                units[static_cast<int>(c.measure)], worst_a, worst_b, n, worst_oracle);
    EXPECT_LE(worst, c.limit);
    EXPECT_LE(worst_oracle, c.oracle_limit);
}

Points spread(double from, double to, int count)
{
    Points points;
    for (int k = 0; k <= count; ++k)
        points.a.push_back(static_cast<float>(from + (to - from) * k / count));
    return points;
}

TEST(math_kernels, exp2_is_within_two_ulp)
{
    check({"exp2", Measure::ulp, 2.0, 4e-9, [](double a, double) { return std::exp2(a); }, spread(-125.0, 127.49, 1500000)});
}

TEST(math_kernels, log2_is_within_four_ulp)
{
    Points points = spread(0.5, 2.0, 1000000);
    for (double x = 1.2e-38; x < 8.5e37; x *= 1.0004)
        points.a.push_back(static_cast<float>(x));
    check({"log2", Measure::ulp, 4.0, 4e-9, [](double a, double) { return std::log2(a); }, points});
}

TEST(math_kernels, sine_and_cosine_are_within_1e7)
{
    const auto sine = [](double a, double) { return std::sin(a); };
    const auto cosine = [](double a, double) { return std::cos(a); };
    const double two_pi = 6.283185307179586;
    check({"sin", Measure::absolute, 1e-7, 5e-9, sine, spread(-two_pi, two_pi, 1000000)});
    check({"cos", Measure::absolute, 1e-7, 5e-9, cosine, spread(-two_pi, two_pi, 1000000)});
    check({"sin", Measure::absolute, 2e-7, 5e-9, sine, spread(-1000.0, 1000.0, 1000000)});
    check({"cos", Measure::absolute, 2e-7, 5e-9, cosine, spread(-1000.0, 1000.0, 1000000)});
}

TEST(math_kernels, acos_is_within_3e7)
{
    check({"acos", Measure::absolute, 3e-7, 5e-9, [](double a, double) { return std::acos(a); }, spread(-1.0, 1.0, 2000000)});
}

TEST(math_kernels, atan2_is_within_3e7)
{
    Points points;
    std::mt19937 random(11);
    const auto coordinate = [&] {
        const float x = static_cast<float>(static_cast<std::int32_t>(random())) * 0x1p-31f;
        return std::ldexp(x, static_cast<int>(random() % 16) - 8);
    };
    for (int k = 0; k < 1000000; ++k) {
        points.a.push_back(coordinate());
        points.b.push_back(coordinate());
    }
    check({"atan2", Measure::absolute, 3e-7, 6e-9, [](double a, double b) { return std::atan2(a, b); }, points});
}

TEST(math_kernels, pow_is_within_1e6_relative)
{
    Points points;
    std::mt19937 random(13);
    while (points.a.size() < 1000000) {
        const double log_x = static_cast<double>(static_cast<std::int32_t>(random())) * 0x1p-31 * (points.a.size() % 2 ? 10.0 : 100.0);
        const float x = static_cast<float>(std::exp2(log_x));
        const float y = static_cast<float>(static_cast<double>(static_cast<std::int32_t>(random())) * 0x1p-28);
        if (std::fabs(log_x * static_cast<double>(y)) > 99.0)
            continue;
        points.a.push_back(x);
        points.b.push_back(y);
    }
    check({"pow", Measure::relative, 1e-6, 5e-8, [](double a, double b) { return std::pow(a, b); }, points});
}

} // namespace
} // namespace burnish
