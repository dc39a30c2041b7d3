// Special functions, Fresnel's equations and slope covariances: known values, laws, errors of the float
// versions.
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

// Largest relative error of a float function of one argument over [low, high].
double largest_error(const char* name, double (*exact)(double), double low, double high)
{
    double worst = 0;
    for (int i = 0; i <= 20000; ++i) {
        const double x = as_float(low + (high - low) * i / 20000);
        const double truth = exact(x);
        if (std::abs(truth) > 1e-30)
            worst = std::max(worst, std::abs(at(name, {x}) / truth - 1));
    }
    std::printf("%s on [%g, %g]: relative error %.3g\n", name, low, high, worst);
    return worst;
}

TEST(SpecialFunctions, float_errors_are_as_documented)
{
    EXPECT_LE(largest_error("exp", std::exp, -86, 88), 3e-7);
    EXPECT_LE(largest_error("expm1", std::expm1, -86, 88), 4e-7);
    EXPECT_LE(largest_error("expm1", std::expm1, -0.4, 0.4), 4e-7);
    EXPECT_LE(largest_error("expm1", std::expm1, -1e-6, 1e-6), 4e-7);
    EXPECT_LE(largest_error("log1p", std::log1p, -0.99999, 3), 5e-7);
    EXPECT_LE(largest_error("log1p", std::log1p, -1e-5, 1e-5), 5e-7);
    EXPECT_LE(largest_error("log1p", std::log1p, 1, 1e6), 5e-7);
}

TEST(SpecialFunctions, error_function_of_its_inverse_is_the_argument)
{
    for (int i = -9999; i <= 9999; ++i) {
        const double x = as_float(i / 10000.0);
        const double y = at("erfinv", {x});
        // 1e-6 of y, seen through the derivative of erf.
        const double slope = 2 / std::sqrt(std::numbers::pi) * std::exp(-y * y);
        ASSERT_NEAR(std::erf(y), x, 1e-6 * std::abs(y) * slope + 1e-12) << x;
    }
    EXPECT_LT(at("erfinv", {1}), 3.9);
    EXPECT_GT(at("erfinv", {-1}), -3.9);
}

TEST(SpecialFunctions, ends_of_the_domains_are_finite)
{
    EXPECT_EQ(at("exp", {-1000}), 0);
    EXPECT_TRUE(std::isfinite(at("exp", {1000})));
    EXPECT_EQ(at("expm1", {-1000}), -1);
    EXPECT_TRUE(std::isfinite(at("log1p", {-1})));
    EXPECT_EQ(at("log1p", {0}), 0);
}

// Fresnel's equations as they stand in books, in complex double.
double fresnel_exact(double c, std::complex<double> n)
{
    const std::complex<double> g = std::sqrt(n * n - 1.0 + c * c);
    const double rs = std::norm((c - g) / (c + g));
    const double rp = std::norm((n * n * c - g) / (n * n * c + g));
    return 0.5 * (rs + rp);
}

TEST(Fresnel, equals_the_complex_equations)
{
    double worst_d = 0, worst_c = 0;
    Random random(31);
    for (int i = 0; i < 20000; ++i) {
        const double c = random.next(), eta = as_float(0.3 + 3 * random.next()),
                     k = as_float(6 * random.next());
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

TEST(Fresnel, keeps_its_digits_near_index_one)
{
    for (const double eta : {1.0001, 0.9999, 1.000001}) {
        for (const double c : {1.0, 0.8125}) {
            const double e = as_float(eta), truth = fresnel_exact(c, e);
            EXPECT_NEAR(at("fresnel_dielectric", {c, e}) / truth, 1, 2e-6);
            EXPECT_NEAR(at("fresnel_conductor", {c, e, 0}) / truth, 1, 2e-6);
        }
    }
}

TEST(Fresnel, limits_are_exact)
{
    EXPECT_FLOAT_EQ(static_cast<float>(at("fresnel_dielectric", {1, 1.5})), 0.04f);
    EXPECT_FLOAT_EQ(static_cast<float>(at("fresnel_f0", {1.5})), 0.04f);
    EXPECT_EQ(at("fresnel_dielectric", {0, 1.5}), 1);
    EXPECT_EQ(at("fresnel_dielectric", {0.5, 1}), 0);
    EXPECT_EQ(at("fresnel_dielectric", {0, 1}), 0);
    EXPECT_EQ(at("fresnel_dielectric", {0.5, 0.6}), 1); // total reflection
    EXPECT_EQ(at("fresnel_dielectric", {0, 0.6}), 1);
    const double brewster = std::cos(std::atan(1.5)); // only light polarised across is left
    EXPECT_NEAR(at("fresnel_dielectric", {brewster, 1.5}), 0.5 * std::pow((1 - 2.25) / (1 + 2.25), 2), 1e-6);
    EXPECT_EQ(at("fresnel_conductor", {0, 0.2, 3.9}), 1);
    EXPECT_EQ(at("fresnel_conductor", {0.5, 1, 0}), 0);
    EXPECT_EQ(at("fresnel_conductor", {0, 1, 0}), 0) << "no interface, no reflection";
    EXPECT_NEAR(at("fresnel_conductor", {0.7, 0, 0}), 1, 1e-6);
    const std::vector<double> gold =
        call(float_fns()[0], "fresnel_conductor3", {1, .143, .375, 1.44, 3.98, 2.39, 1.60});
    EXPECT_NEAR(gold[0], fresnel_exact(1, {.143, 3.98}), 1e-6);
    EXPECT_NEAR(gold[1], fresnel_exact(1, {.375, 2.39}), 1e-6);
    EXPECT_NEAR(gold[2], fresnel_exact(1, {1.44, 1.60}), 1e-6);
    EXPECT_FLOAT_EQ(static_cast<float>(at("fresnel_schlick", {1, .04})), 0.04f);
    EXPECT_EQ(at("fresnel_schlick", {0, .04}), 1);
}

struct Axes {
    double sigma_u, sigma_v, x, y, alpha_lin, eta;
};
Axes axes_of(const std::vector<double>& s)
{
    const std::vector<double> r = call(float_fns()[0], "covariance_axes", s);
    return {r[0], r[1], r[2], r[3], r[4], r[5]};
}

TEST(Covariance, deviations_follow_from_roughness_and_anisotropy)
{
    const Axes a = axes_of(call(float_fns()[0], "covariance_eta", {.5, .8, 1, 0}));
    EXPECT_NEAR(a.sigma_u, .31819805, 1e-7);
    EXPECT_NEAR(a.sigma_v, .03535534, 1e-6);
    EXPECT_NEAR(a.alpha_lin, .5, 1e-6);
    EXPECT_NEAR(a.eta, .8, 1e-5);
    EXPECT_EQ(a.x, 1);
    const Axes crossed = axes_of(
        call(float_fns()[0], "covariance_eta", {.6, -.7, 1, 0})); // sorted: the axis turns by 90 degrees
    EXPECT_NEAR(crossed.sigma_u, .43274935, 1e-7);
    EXPECT_NEAR(crossed.sigma_v, .07636753, 1e-6);
    EXPECT_EQ(crossed.x, 0);
    EXPECT_EQ(crossed.y, 1);
}

TEST(Covariance, decomposition_is_the_inverse)
{
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        const double angle = (i - 1000) * std::numbers::pi / 2001, eta = 0.02 + 0.9 * (i % 97) / 97.0;
        const std::vector<double> s =
            call(float_fns()[0], "covariance_eta", {.4, eta, std::cos(angle), std::sin(angle)});
        const Axes a = axes_of(s);
        const double sine = a.x * std::sin(angle) - a.y * std::cos(angle);
        worst = std::max(worst, std::abs(sine) * eta);
        ASSERT_NEAR(a.eta, eta, 1e-4);
        ASSERT_GE(a.x, 0);
        ASSERT_NEAR(a.x * a.x + a.y * a.y, 1, 1e-6);
    }
    std::printf("axis of float covariances: error times eta %.3g rad\n", worst);
    EXPECT_LE(worst, 1e-6);
}

TEST(Covariance, degenerate_matrices_have_axes)
{
    const double bad[][3] = {
        {0, 0, 0},         {1e-3, 1e-3, 0},  {1e-3, 1e-3, 1e-20}, {1e-3, 2e-3, 1e-25},  {2e-3, 1e-3, -1e-25},
        {0, 1e-3, 0},      {1e-3, 0, 0},     {1e-3, 1e-3, 2e-3},  {1e-3, 1e-3, -2e-3},  {1e-12, 1e-12, 1e-13},
        {1e-30, 1e-35, 0}, {-1e-9, 1e-9, 0}, {0.5, 1e-9, 1e-5},   {1e-38, 2e-38, 1e-38}};
    for (const auto& m : bad) {
        const Axes a = axes_of({m[0], m[1], m[2]});
        EXPECT_NEAR(a.x * a.x + a.y * a.y, 1, 1e-6) << m[0] << " " << m[1] << " " << m[2];
        EXPECT_GE(a.sigma_v, 0.7071e-3);
        EXPECT_GE(a.sigma_u, a.sigma_v);
        EXPECT_LE(a.sigma_u, 1);
        EXPECT_TRUE(a.eta >= 0 && a.eta < 1);
    }
    const Axes steep = axes_of({1e-3, 2e-3, 1e-25});
    EXPECT_EQ(steep.y, 1) << "the axis of the larger entry, though the other is lost in rounding";
}

TEST(Covariance, a_texel_without_direction_is_isotropic)
{
    const double middle = 2 * (128 / 255.0) - 1; // eight bits cannot say zero
    for (const double d : {0.0, middle}) {
        const std::vector<double> s = call(float_fns()[0], "covariance_eta", {.5, .8, d, d});
        EXPECT_FLOAT_EQ(static_cast<float>(s[0]), 0.03125f);
        EXPECT_EQ(s[0], s[1]);
        EXPECT_EQ(s[2], 0);
    }
    const std::vector<double> khr =
        call(float_fns()[0], "covariance_khr", {.25, 1, 1, 0, 128 / 255.0, 128 / 255.0, 1});
    EXPECT_EQ(khr[0], khr[1]);
    EXPECT_NEAR(khr[0], 0.03125, 1e-7);
}

// alpha_t = mix(alpha, 1, strength^2), alpha_b = alpha.
TEST(Covariance, follows_khr_materials_anisotropy)
{
    const double alpha = .16, strength = .6;
    const double turn = .5, c = std::cos(turn), s = std::sin(turn);
    const double alpha_t = alpha + (1 - alpha) * strength * strength;
    const Axes plain = axes_of(call(float_fns()[0], "covariance_khr", {alpha, strength, 1, 0, 1, .5, 1}));
    EXPECT_NEAR(plain.sigma_u, alpha_t / std::numbers::sqrt2, 1e-6);
    EXPECT_NEAR(plain.sigma_v, alpha / std::numbers::sqrt2, 1e-6);
    EXPECT_NEAR(plain.x, 1, 1e-6);
    const Axes turned = axes_of(call(float_fns()[0], "covariance_khr", {alpha, strength, c, s, 1, .5, 1}));
    EXPECT_NEAR(turned.x, c, 1e-6) << "counter-clockwise from the tangent";
    EXPECT_NEAR(turned.y, s, 1e-6);
    const Axes texel = axes_of(call(float_fns()[0], "covariance_khr",
                                    {alpha, strength, c, s, .5, 1, .5})); // +bitangent, half strength
    EXPECT_NEAR(texel.x, s, 1e-6);
    EXPECT_NEAR(texel.y, -c, 1e-6);
    EXPECT_NEAR(texel.sigma_u, (alpha + (1 - alpha) * .09) / std::numbers::sqrt2, 1e-6);
    const Axes none = axes_of(call(float_fns()[0], "covariance_khr", {alpha, 0, c, s, 1, .5, 1}));
    EXPECT_NEAR(none.eta, 0, 1e-5);
}

TEST(Covariance, mixing_crossed_grains_gives_an_isotropic_surface)
{
    const std::vector<double> a = call(float_fns()[0], "covariance_eta", {.5, .8, 1, 0});
    const std::vector<double> b = call(float_fns()[0], "covariance_eta", {.5, .8, 0, -1});
    const std::vector<double> m =
        call(float_fns()[0], "covariance_mixed", {a[0], a[1], a[2], b[0], b[1], b[2], .5});
    EXPECT_NEAR(m[0], m[1], 1e-8);
    EXPECT_NEAR(m[2], 0, 1e-9);
}

} // namespace
} // namespace burnish::test
