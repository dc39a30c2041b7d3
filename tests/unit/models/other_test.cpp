// Special functions and Fresnel's equations: known values, laws, errors of the float versions.
#include <cmath>
#include <complex>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

double at(const char* name, const std::vector<double>& in)
{
    return call(float_fns()[0], name, in)[0];
}
double as_float(double x)
{
    return rounded({x, 0, 0})[0];
}

// Returns the largest relative error of a one-argument float function over [low, high].
double largest_error(const char* name, double (*exact)(double), double low, double high)
{
    double worst = 0;
    for (int i = 0; i <= 20000; ++i) {
        const double x = as_float(low + (high - low) * i / 20000);
        const double reference = exact(x);
        if (std::abs(reference) > 1e-30)
            worst = std::max(worst, std::abs(at(name, {x}) / reference - 1));
    }
    std::printf("%s on [%g, %g]: relative error %.3g\n", name, low, high, worst);
    return worst;
}

TEST(special_functions, float_errors_are_as_documented)
{
    EXPECT_LE(largest_error("exp", std::exp, -86, 88), 3e-7);
    EXPECT_LE(largest_error("expm1", std::expm1, -86, 88), 4e-7);
    EXPECT_LE(largest_error("expm1", std::expm1, -0.4, 0.4), 4e-7);
    EXPECT_LE(largest_error("expm1", std::expm1, -1e-6, 1e-6), 4e-7);
    EXPECT_LE(largest_error("log1p", std::log1p, -0.99999, 3), 5e-7);
    EXPECT_LE(largest_error("log1p", std::log1p, -1e-5, 1e-5), 5e-7);
    EXPECT_LE(largest_error("log1p", std::log1p, 1, 1e6), 5e-7);
}

TEST(special_functions, error_function_of_its_inverse_is_the_argument)
{
    for (int i = -9999; i <= 9999; ++i) {
        const double x = as_float(i / 10000.0);
        const double y = at("erfinv", {x});
        // 1e-6 of y, multiplied by the derivative of erf.
        const double slope = 2 / std::sqrt(std::numbers::pi) * std::exp(-y * y);
        ASSERT_NEAR(std::erf(y), x, 1e-6 * std::abs(y) * slope + 1e-12) << x;
    }
    EXPECT_LT(at("erfinv", {1}), 3.9);
    EXPECT_GT(at("erfinv", {-1}), -3.9);
}

TEST(special_functions, ends_of_the_domains_are_finite)
{
    EXPECT_EQ(at("exp", {-1000}), 0);
    EXPECT_TRUE(std::isfinite(at("exp", {1000})));
    EXPECT_EQ(at("expm1", {-1000}), -1);
    EXPECT_TRUE(std::isfinite(at("log1p", {-1})));
    EXPECT_EQ(at("log1p", {0}), 0);
}

// Returns Fresnel's reflectance from the textbook equations, in complex double.
double fresnel_exact(double c, std::complex<double> n)
{
    const std::complex<double> g = std::sqrt(n * n - 1.0 + c * c);
    const double rs = std::norm((c - g) / (c + g));
    const double rp = std::norm((n * n * c - g) / (n * n * c + g));
    return 0.5 * (rs + rp);
}

TEST(fresnel, equals_the_complex_equations)
{
    double worst_d = 0, worst_c = 0;
    Random random(31);
    for (int i = 0; i < 20000; ++i) {
        const double c = random.next(), eta = as_float(0.3 + 3 * random.next()), k = as_float(6 * random.next());
        const double d = fresnel_exact(c, eta), m = fresnel_exact(c, {eta, k});
        worst_d = std::max(worst_d, std::abs(at("fresnel_dielectric", {c, eta}) - d));
        worst_c = std::max(worst_c, std::abs(at("fresnel_conductor", {c, eta, k}) / m - 1));
        ASSERT_NEAR(call(oracle_fns(), "fresnel_dielectric", {c, eta})[0], d, 1e-12);
        ASSERT_NEAR(call(oracle_fns(), "fresnel_conductor", {c, eta, k})[0], m, 1e-12);
        ASSERT_NEAR(call(oracle_fns(), "fresnel_conductor", {c, eta, 0})[0], d, 1e-12);
    }
    std::printf("float: dielectric %.3g absolute, conductor %.3g relative\n", worst_d, worst_c);
    EXPECT_LE(worst_d, 1.1e-5); // at the onset of total reflection the slope is infinite
    EXPECT_LE(worst_c, 1.5e-6);
}

TEST(fresnel, keeps_its_digits_near_index_one)
{
    for (const double eta : {1.0001, 0.9999, 1.000001}) {
        for (const double c : {1.0, 0.8125}) {
            const double e = as_float(eta), reference = fresnel_exact(c, e);
            EXPECT_NEAR(at("fresnel_dielectric", {c, e}) / reference, 1, 2e-6);
            EXPECT_NEAR(at("fresnel_conductor", {c, e, 0}) / reference, 1, 2e-6);
        }
    }
}

TEST(fresnel, limits_are_exact)
{
    EXPECT_FLOAT_EQ(static_cast<float>(at("fresnel_dielectric", {1, 1.5})), 0.04f);
    EXPECT_FLOAT_EQ(static_cast<float>(at("fresnel_f0", {1.5})), 0.04f);
    EXPECT_EQ(at("fresnel_dielectric", {0, 1.5}), 1);
    EXPECT_EQ(at("fresnel_dielectric", {0.5, 1}), 0);
    EXPECT_EQ(at("fresnel_dielectric", {0, 1}), 0);
    EXPECT_EQ(at("fresnel_dielectric", {0.5, 0.6}), 1); // total reflection
    EXPECT_EQ(at("fresnel_dielectric", {0, 0.6}), 1);
    const double brewster = std::cos(std::atan(1.5)); // only light polarised across the plane is left
    EXPECT_NEAR(at("fresnel_dielectric", {brewster, 1.5}), 0.5 * std::pow((1 - 2.25) / (1 + 2.25), 2), 1e-6);
    EXPECT_EQ(at("fresnel_conductor", {0, 0.2, 3.9}), 1);
    EXPECT_EQ(at("fresnel_conductor", {0.5, 1, 0}), 0);
    EXPECT_EQ(at("fresnel_conductor", {0, 1, 0}), 0) << "no interface, no reflection";
    EXPECT_NEAR(at("fresnel_conductor", {0.7, 0, 0}), 1, 1e-6);
    EXPECT_EQ(at("fresnel_dielectric", {1.1, 1.5}), at("fresnel_dielectric", {1, 1.5})) << "cosines beyond the ends";
    EXPECT_EQ(at("fresnel_dielectric", {-.1, 1.5}), 1);
    EXPECT_EQ(at("fresnel_conductor", {1.1, .2, 3.9}), at("fresnel_conductor", {1, .2, 3.9}));
    EXPECT_EQ(at("fresnel_conductor", {-.1, .2, 3.9}), 1);
    const std::vector<double> gold = call(float_fns()[0], "fresnel_conductor3", {1, .143, .375, 1.44, 3.98, 2.39, 1.60});
    EXPECT_NEAR(gold[0], fresnel_exact(1, {.143, 3.98}), 1e-6);
    EXPECT_NEAR(gold[1], fresnel_exact(1, {.375, 2.39}), 1e-6);
    EXPECT_NEAR(gold[2], fresnel_exact(1, {1.44, 1.60}), 1e-6);
    EXPECT_FLOAT_EQ(static_cast<float>(at("fresnel_schlick", {1, .04})), 0.04f);
    EXPECT_EQ(at("fresnel_schlick", {0, .04}), 1);
}

} // namespace
} // namespace burnish::test
