// Known values of every model, mostly computed by independent means in double precision.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

#include "tests/unit/models/point.h"

namespace burnish::test {
namespace {

TEST(ggx_vectors, directional_albedo_matches_brute_force)
{
    const double cases[][3] = {{.2, .5, .963 + .032}, {.5, .3, .772 + .065}, {.9, .8, .453 + .001}}; // roughness, n.v, albedo
    for (const auto& c : cases) {
        const double alpha = c[0] * c[0];
        const Vec wo = direction(std::acos(c[1]), 0.3);
        EXPECT_NEAR(albedo("ggx", {{alpha}, {alpha, alpha}}, wo, 512), c[2], 1.5e-3);
        EXPECT_NEAR(albedo("ggx_aniso", {{alpha, alpha}, {alpha, alpha}}, wo, 512), c[2], 1.5e-3);
    }
}

TEST(ggx_vectors, equals_the_ellipsoid_where_it_is_not_tilted)
{
    for (const Pair& p : kPairs)
        EXPECT_NEAR(eval("ggx_aniso_separable", {.3, .6}, p.v, p.l), eval("ellipsoid", {.3, .6}, p.v, p.l), 1e-12);
    for (const Pair& p : kPairs) {
        EXPECT_NEAR(eval("ggx_aniso", {.3, .6}, p.v, p.l), eval("ellipsoid_correlated", {.3, .6}, p.v, p.l), 1e-12);
        const Sampled level = sample("ggx_aniso", {.3, .6}, p.v, .3, .8), upright = sample("ellipsoid_correlated", {.3, .6}, p.v, .3, .8);
        expect_near(level.wi, upright.wi, 1e-12);
        EXPECT_NEAR(level.weight, upright.weight, 1e-12);
        EXPECT_NEAR(level.pdf, upright.pdf, 1e-12);
    }
}

TEST(ggx_vectors, isotropic_and_anisotropic_agree)
{
    for (const Pair& p : kPairs) {
        EXPECT_NEAR(eval("ggx", {.3}, p.v, p.l), eval("ggx_aniso", {.3, .3}, p.v, p.l), 1e-12);
        const Sampled one = sample("ggx", {.3}, p.v, .3, .8), other = sample("ggx_aniso", {.3, .3}, p.v, .3, .8);
        expect_near(one.wi, other.wi, 1e-12);
        EXPECT_NEAR(one.weight, other.weight, 1e-12);
        EXPECT_NEAR(one.pdf, other.pdf, 1e-12);
        EXPECT_GT(one.weight, 0);
    }
}

TEST(beckmann_vectors, samples_are_those_of_filtered_importance_sampling)
{
    const Vec v = {std::sin(.8), 0, std::cos(.8)};
    const Sampled edge = sample("beckmann", {.4, .1}, v, .1, .5);
    expect_near(edge.wi, {-.10431564, 0, .99454424}, 2e-7);
    EXPECT_NEAR(edge.weight, 1.37322083, 2e-6);
    // lod of the filtered fetch, from the density: .5 log2(6 w^2 / (4 pi n^2 pdf)).
    const auto lod = [](double pdf) { return .5 * std::log2(6 * 512. * 512. / (4 * std::numbers::pi * 25 * pdf)); };
    EXPECT_NEAR(lod(edge.pdf), 6.03098366, 2e-6);
    const Sampled middle = sample("beckmann", {.4, .1}, v, .5, .5);
    expect_near(middle.wi, {-v[0], 0, v[2]}, 2e-7);
    EXPECT_NEAR(middle.weight, 1, 1e-6);
    EXPECT_NEAR(lod(middle.pdf), 5.38793674, 2e-6);
    double sum = 0;
    for (int i = 0; i < 25; ++i)
        sum += sample("beckmann", {.4, .1}, v, (i % 5 + .5) / 5, (i / 5 + .5) / 5).weight;
    EXPECT_NEAR(sum / 25, .93371920, 2e-6);
}

TEST(beckmann_vectors, albedo_is_known)
{
    const double cases[][2] = {{.3, .968}, {1, .906}, {1.4, .945}};
    for (const auto& c : cases)
        EXPECT_NEAR(albedo("beckmann", {{.5, .1}, {.5, .1}}, direction(c[0], 0), 512), c[1], 1.5e-3);
}

// Smith's integral for Gaussian slopes: Lambda = (exp(-c^2) / (c sqrt(pi)) - erfc(c)) / 2. The rational function is within 0.35 % of the
// resulting masking (Walter et al. 2007).
TEST(beckmann_vectors, masking_is_that_of_gaussian_slopes)
{
    double worst = 0;
    for (int i = 1; i <= 400; ++i) {
        const double c = i / 100.0, alpha = .4;
        const Vec w = unit({1, 0, c * alpha}); // c = z / (alpha x)
        const double exact = .5 * (std::exp(-c * c) / (c * std::sqrt(std::numbers::pi)) - std::erfc(c));
        const double lambda = call(oracle_fns(), "beckmann_lambda", {alpha, .1, w[0], w[1], w[2]})[0];
        worst = std::max(worst, std::abs((1 + exact) / (1 + lambda) - 1));
    }
    EXPECT_LE(worst, .0036);
    EXPECT_GT(worst, 1e-4);
}

TEST(ward_vectors, both_exponents_and_densities_are_known)
{
    const double cheap[] = {.47211455, 1.76838826, 2.61921078}, exact[] = {.45436818, 1.76838826, 2.60028259};
    const double p_h[] = {1.73953138, 7.07355303, 4.16788650}, p_l[] = {.47043388, 7.07355303 / 4, 2.57643840};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [v, l] = kPairs[i];
        EXPECT_NEAR(eval("ward_cheap", {.3, .15}, v, l), cheap[i], 1e-7);
        EXPECT_NEAR(eval("ward", {.3, .15}, v, l), exact[i], 1e-7);
        EXPECT_NEAR(half_pdf("ward", {.3, .15}, v, l), p_h[i], 1e-7);
        EXPECT_NEAR(value("ward", true, {.3, .15}, v, l), p_l[i], 1e-7);
    }
    const std::vector<double> h = call(oracle_fns(), "ward_half", {.4, .2, .1, .5});
    expect_near({h[0], h[1], h[2]}, {.25899021, .09408370, .96128681}, 3e-8);
}

TEST(ward_vectors, exponents_differ_by_a_fifth)
{
    const Vec h = {.3, .2, .93273791}; // seen along itself, so that h is the half vector
    EXPECT_NEAR(half_pdf("ward", {.4, .2}, h, h) * std::numbers::pi * .08 * std::pow(h[2], 3), .16596522, 2e-8);
    EXPECT_NEAR(half_pdf("ward_cheap", {.4, .2}, h, h) * std::numbers::pi * .08, .19851765, 2e-8);
}

// The exact exponent gives less; both from double-precision quadrature of Ward's formulas (2000^2 half vectors).
TEST(ward_vectors, albedos_are_known)
{
    const double cases[][3] = {{.2, .838, .76881}, {1, .527, .46193}, {1.4, .366, .29151}, {1.5, .407, .30906}};
    for (const auto& c : cases) {
        const Vec wo = direction(c[0], 0);
        EXPECT_NEAR(albedo("ward_cheap", {{.4, .2}, {.4, .2}}, wo, 256), c[1], 1e-3);
        EXPECT_NEAR(albedo("ward", {{.4, .2}, {.4, .2}}, wo, 256), c[2], 1e-3);
    }
}

// With xi.y = 1 - exp(-2 E (1 - cos)) the half vector's cosine is known along either axis.
TEST(ward_vectors, half_vectors_of_the_cheap_exponent_are_known)
{
    for (const IsaFns& isa : {float_fns()[0], oracle_fns()})
        for (double z : {.999, .95, .5}) {
            const std::vector<double> x = call(isa, "ward_cheap_half", {.8, .2, 0, 1 - std::exp(-2 * (1 - z) / .64)});
            expect_near({x[0], x[1], x[2]}, {std::sqrt(1 - z * z), 0, z}, 1e-6);
        }
    const std::vector<double> y = call(oracle_fns(), "ward_cheap_half", {.2, .8, .75, 1 - std::exp(-2 * (1 - .7) / .64)});
    expect_near({y[0], y[1], y[2]}, {0, -std::sqrt(1 - .49), .7}, 1e-7);
    const std::vector<double> below = call(oracle_fns(), "ward_cheap_half", {1, 1, 0, 1 - std::exp(-2 * 1.01)});
    expect_near({below[0], below[1], below[2]}, {1, 0, 0}, 1e-12);
    const std::vector<double> above = call(oracle_fns(), "ward_cheap_half", {1, 1, 0, 1 - std::exp(-2 * .99)});
    expect_near({above[0], above[1], above[2]}, {std::sqrt(1 - 1e-4), 0, .01}, 1e-7);
}

TEST(ashikhmin_shirley_vectors, values_and_densities_are_known)
{
    const double p_h[] = {3.63946769, 5.30489950, 3.57121879}, p_l[] = {.98424720, 1.32622488, 2.20759976};
    const double f[] = {.04173189, .05304900, .50189264}; // with Schlick's factor, f0 = 0.04
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [v, l] = kPairs[i];
        EXPECT_NEAR(half_pdf("ashikhmin_shirley", {100, 10}, v, l), p_h[i], 1e-7);
        EXPECT_NEAR(value("ashikhmin_shirley", true, {100, 10}, v, l), p_l[i], 1e-7);
        const double fresnel = call(oracle_fns(), "fresnel_schlick", {dot(v, unit(v + l)), .04})[0];
        EXPECT_NEAR(eval("ashikhmin_shirley", {100, 10}, v, l) * fresnel, f[i], 1e-7);
    }
}

TEST(ashikhmin_shirley_vectors, half_vectors_are_known_in_all_quadrants)
{
    const double cases[][7] = {{100, 10, .1, .5, .09355066, .20595495, .97407948}, {100, 10, .3, .25, -.02304719, .21493459, .97635647},
                               {100, 10, .25, .5, 0, .34410572, .93893091},        {100, 10, .6, .9, -.16548205, -.36431434, .91645554},
                               {2e4, 70, .1, .5, .00672392, .08199367, .99661017}, {2e4, 70, 0, 0, 0, 0, 1}};
    for (const auto& c : cases)
        for (const IsaFns& isa : {float_fns()[0], oracle_fns()}) {
            const std::vector<double> h = call(isa, "ashikhmin_shirley_half", {c[0], c[1], c[2], c[3]});
            expect_near({h[0], h[1], h[2]}, {c[4], c[5], c[6]}, 5e-7);
        }
}

TEST(ashikhmin_shirley_vectors, both_parts_of_the_albedo_are_known)
{
    // nu nv theta phi; shares of the light that multiply f0 and 1 - f0 in Schlick's factor
    const double cases[][6] = {{20, 20, .5, 0, .80441089, .00032332},
                               {100, 10, 1.2, .7, .60681231, .04751581},
                               {5, 50, 1.4, 1.3, .42194661, .13549095},
                               {1, 1, .2, 0, .25494808, .00003526}};
    for (const auto& c : cases) {
        const Setting setting = {{c[0], c[1], 0, 0, 0, 0}, {1 / std::sqrt(c[0]), 1 / std::sqrt(c[1])}};
        const Vec wo = direction(c[2], c[3]);
        const Chart chart = chart_of(model_case("ashikhmin_shirley"), setting, wo);
        constexpr std::size_t kGrid = 512;
        Batch batch(setting.params, kGrid * kGrid);
        std::vector<double> by_f0(kGrid * kGrid), by_rest(kGrid * kGrid);
        for (std::size_t k = 0; k < kGrid * kGrid; ++k) {
            const Chart::Point p = chart.at((static_cast<double>(k / kGrid) + .5) / kGrid, (static_cast<double>(k % kGrid) + .5) / kGrid);
            const double chi = std::pow(1 - std::min(dot(wo, p.h), 1.0), 5), measure = p.per_wi * p.wi[2] / (kGrid * kGrid);
            batch.set(k, wo, p.wi);
            by_f0[k] = p.per_wi > 0 ? (1 - chi) * measure : 0;
            by_rest[k] = p.per_wi > 0 ? chi * measure : 0;
        }
        const std::vector<double> f = batch.run(fns_of(oracle_fns(), model_case("ashikhmin_shirley")).eval);
        EXPECT_NEAR(std::inner_product(f.begin(), f.end(), by_f0.begin(), 0.0), c[4], 3e-4);
        EXPECT_NEAR(std::inner_product(f.begin(), f.end(), by_rest.begin(), 0.0), c[5], 3e-4 * c[5] + 1e-6);
    }
}

TEST(ashikhmin_shirley_vectors, exponents_follow_from_widths)
{
    EXPECT_NEAR(call(oracle_fns(), "ashikhmin_shirley_of_alpha", {.1, .5})[0], 100, 1e-9);
    EXPECT_NEAR(call(oracle_fns(), "ashikhmin_shirley_of_alpha", {.1, 0})[1], 1e6, 1e-3);
}

TEST(heidrich_seidel_vectors, diffuse_and_mirror_terms_are_known)
{
    struct Case {
        Vec l, v;
        double diffuse, mirror; // mirror: before the clamp
    };
    const Case cases[] = {{unit({.3, .4, .8}), unit({-.2, .5, .9}), .94809093, .99133338},
                          {unit({1, 0, .2}), unit({-1, 0, .2}), .19611614, 1},
                          {{0, .6, .8}, {0, -.6, .8}, 1, 1},
                          {unit({.9, .1, .3}), unit({.8, .1, .3}), .33149677, -.75553595}};
    for (const Case& c : cases) {
        EXPECT_NEAR(call(oracle_fns(), "thread_diffuse", {c.l[0], c.l[1], c.l[2]})[0], c.diffuse, 1e-8);
        EXPECT_NEAR(call(oracle_fns(), "thread_mirror", {c.v[0], c.v[1], c.v[2], c.l[0], c.l[1], c.l[2]})[0], std::max(c.mirror, 0.0),
                    1e-8);
        EXPECT_NEAR(c.diffuse * call(oracle_fns(), "thread_diffuse", {c.v[0], c.v[1], c.v[2]})[0] - c.l[0] * c.v[0], c.mirror, 1e-8);
        const double expected = .3 * c.diffuse + .6 * std::pow(std::max(c.mirror, 0.0), 20);
        EXPECT_NEAR(eval("heidrich_seidel", {.3, .6, 20}, c.v, c.l), expected, 1e-6);
    }
}

} // namespace
} // namespace burnish::test
