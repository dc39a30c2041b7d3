// Known values of every model, most computed by independent means in double precision.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

double value(const char* model, bool pdf, const std::vector<double>& params, Vec wo, Vec wi)
{
    std::vector<double> padded = params;
    padded.resize(kMaxParams);
    Batch batch(padded, 1);
    batch.set(0, wo, wi);
    const ModelFns& fns = oracle_fns().models[model_case(model).index];
    return batch.run(pdf ? fns.pdf : fns.eval)[0];
}
double eval(const char* model, const std::vector<double>& params, Vec wo, Vec wi)
{
    return value(model, false, params, wo, wi);
}
double half_pdf(const char* model, const std::vector<double>& params, Vec wo, Vec wi)
{
    std::vector<double> padded = params;
    padded.resize(kMaxParams);
    Batch batch(padded, 1);
    batch.set(0, wo, unit(wo + wi));
    return batch.run(oracle_fns().models[model_case(model).index].half_pdf)[0];
}
struct Sampled {
    Vec wi;
    double weight, pdf, o_dot_h, valid;
};
Sampled sample(const char* model, const std::vector<double>& params, Vec wo, double x, double y)
{
    std::vector<double> padded = params;
    padded.resize(kMaxParams);
    Batch batch(padded, 1);
    batch.set(0, wo, {x, y, 0});
    const std::vector<double> s =
        batch.run(oracle_fns().models[model_case(model).index].sample, kSampleOutputs);
    return {{s[0], s[1], s[2]}, s[3], s[4], s[5], s[6]};
}
void expect_near(Vec a, Vec b, double tolerance)
{
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}
double albedo(const char* model, const Setting& setting, Vec wo, int grid)
{
    Setting padded = setting;
    padded.params.resize(kMaxParams);
    return integral(model_case(model), padded, wo, Integrand::albedo, grid);
}

const Vec kUp = {0, 0, 1};
struct Pair {
    Vec v, l;
};
const Pair kPairs[] = {
    {unit({.3, .1, .9}), unit({-.4, .2, .8})}, {kUp, kUp}, {unit({.9, .2, .3}), unit({-.7, -.1, .4})}};

TEST(GgxVectors, directional_albedo_matches_brute_force)
{
    const double cases[][3] = {
        {.2, .5, .963 + .032}, {.5, .3, .772 + .065}, {.9, .8, .453 + .001}}; // alpha_lin, n.v, albedo
    for (const auto& c : cases) {
        const double alpha = c[0] * c[0];
        const Vec wo = direction(std::acos(c[1]), 0.3);
        EXPECT_NEAR(albedo("ggx", {{alpha}, {alpha, alpha}}, wo, 512), c[2], 1.5e-3);
        EXPECT_NEAR(albedo("ggx_aniso", {{alpha, alpha}, {alpha, alpha}}, wo, 512), c[2], 1.5e-3);
    }
}

TEST(GgxVectors, equals_the_ellipsoid_where_it_is_not_tilted)
{
    for (const Pair& p : kPairs)
        EXPECT_NEAR(eval("ggx_aniso_separable", {.3, .6}, p.v, p.l), eval("ellipsoid", {.3, .6}, p.v, p.l),
                    1e-12);
}

TEST(GgxVectors, isotropic_and_anisotropic_agree)
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

TEST(BeckmannVectors, samples_are_those_of_filtered_importance_sampling)
{
    const Vec v = {std::sin(.8), 0, std::cos(.8)};
    const Sampled edge = sample("beckmann", {.4, .1}, v, .1, .5);
    expect_near(edge.wi, {-.10431564, 0, .99454424}, 2e-7);
    EXPECT_NEAR(edge.weight, 1.37322083, 2e-6);
    // lod of the filtered fetch, from the density: .5 log2(6 w^2 / (4 pi n^2 pdf)).
    const auto lod = [](double pdf) {
        return .5 * std::log2(6 * 512. * 512. / (4 * std::numbers::pi * 25 * pdf));
    };
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

TEST(BeckmannVectors, albedo_is_known)
{
    const double cases[][2] = {{.3, .968}, {1, .906}, {1.4, .945}};
    for (const auto& c : cases)
        EXPECT_NEAR(albedo("beckmann", {{.5, .1}, {.5, .1}}, direction(c[0], 0), 512), c[1], 1.5e-3);
}

// Smith's integral for Gaussian slopes: Lambda = (exp(-c^2) / (c sqrt(pi)) - erfc(c)) / 2; the rational function is within 0.35 %
// of the masking that follows (Walter et al. 2007).
TEST(BeckmannVectors, masking_is_that_of_gaussian_slopes)
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

TEST(WardVectors, both_exponents_and_densities_are_known)
{
    const double cheap[] = {.47211455, 1.76838826, 2.61921078}, exact[] = {.45436818, 1.76838826, 2.60028259};
    const double p_h[] = {1.73953138, 7.07355303, 4.16788650},
                 p_l[] = {.47043388, 7.07355303 / 4, 2.57643840};
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

TEST(WardVectors, exponents_differ_by_a_fifth)
{
    const Vec h = {.3, .2, .93273791}; // seen along itself, so that h is the half vector
    EXPECT_NEAR(half_pdf("ward", {.4, .2}, h, h) * std::numbers::pi * .08 * std::pow(h[2], 3), .16596522, 2e-8);
    EXPECT_NEAR(half_pdf("ward_cheap", {.4, .2}, h, h) * std::numbers::pi * .08, .19851765, 2e-8);
}

// The exact exponent gives less; both by quadrature in double of Ward's formulas (2000^2 half vectors).
TEST(WardVectors, albedos_are_known)
{
    const double cases[][3] = {{.2, .838, .76881}, {1, .527, .46193}, {1.4, .366, .29151}, {1.5, .407, .30906}};
    for (const auto& c : cases) {
        const Vec wo = direction(c[0], 0);
        EXPECT_NEAR(albedo("ward_cheap", {{.4, .2}, {.4, .2}}, wo, 256), c[1], 1e-3);
        EXPECT_NEAR(albedo("ward", {{.4, .2}, {.4, .2}}, wo, 256), c[2], 1e-3);
    }
}

// With xi.y = 1 - exp(-2 E (1 - cos)) the half vector's cosine is known, along either axis.
TEST(WardVectors, half_vectors_of_the_cheap_exponent_are_known)
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

TEST(AshikhminShirleyVectors, values_and_densities_are_known)
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

TEST(AshikhminShirleyVectors, half_vectors_are_known_in_all_quadrants)
{
    const double cases[][7] = {{100, 10, .1, .5, .09355066, .20595495, .97407948},
                               {100, 10, .3, .25, -.02304719, .21493459, .97635647},
                               {100, 10, .25, .5, 0, .34410572, .93893091},
                               {100, 10, .6, .9, -.16548205, -.36431434, .91645554},
                               {2e4, 70, .1, .5, .00672392, .08199367, .99661017},
                               {2e4, 70, 0, 0, 0, 0, 1}};
    for (const auto& c : cases)
        for (const IsaFns& isa : {float_fns()[0], oracle_fns()}) {
            const std::vector<double> h = call(isa, "ashikhmin_shirley_half", {c[0], c[1], c[2], c[3]});
            expect_near({h[0], h[1], h[2]}, {c[4], c[5], c[6]}, 5e-7);
        }
}

TEST(AshikhminShirleyVectors, both_parts_of_the_albedo_are_known)
{
    // nu nv theta phi; shares of the light that go with f0 and with 1 - f0 of Schlick's factor
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
            const Chart::Point p = chart.at((static_cast<double>(k / kGrid) + .5) / kGrid,
                                            (static_cast<double>(k % kGrid) + .5) / kGrid);
            const double chi = std::pow(1 - std::min(dot(wo, p.h), 1.0), 5), measure = p.per_wi * p.wi[2] / (kGrid * kGrid);
            batch.set(k, wo, p.wi);
            by_f0[k] = p.per_wi > 0 ? (1 - chi) * measure : 0;
            by_rest[k] = p.per_wi > 0 ? chi * measure : 0;
        }
        const std::vector<double> f = batch.run(oracle_fns().models[model_case("ashikhmin_shirley").index].eval);
        EXPECT_NEAR(std::inner_product(f.begin(), f.end(), by_f0.begin(), 0.0), c[4], 3e-4);
        EXPECT_NEAR(std::inner_product(f.begin(), f.end(), by_rest.begin(), 0.0), c[5], 3e-4 * c[5] + 1e-6);
    }
}

TEST(AshikhminShirleyVectors, exponents_follow_from_widths)
{
    EXPECT_NEAR(call(oracle_fns(), "ashikhmin_shirley_of_alpha", {.1, .5})[0], 100, 1e-9);
    EXPECT_NEAR(call(oracle_fns(), "ashikhmin_shirley_of_alpha", {.1, 0})[1], 1e6, 1e-3);
}

TEST(HeidrichSeidelVectors, diffuse_and_mirror_terms_are_known)
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
        EXPECT_NEAR(call(oracle_fns(), "thread_mirror", {c.v[0], c.v[1], c.v[2], c.l[0], c.l[1], c.l[2]})[0],
                    std::max(c.mirror, 0.0), 1e-8);
        EXPECT_NEAR(c.diffuse * call(oracle_fns(), "thread_diffuse", {c.v[0], c.v[1], c.v[2]})[0] - c.l[0] * c.v[0], c.mirror, 1e-8);
        const double expected = .3 * c.diffuse + .6 * std::pow(std::max(c.mirror, 0.0), 20);
        EXPECT_NEAR(eval("heidrich_seidel", {.3, .6, 20}, c.v, c.l), expected, 1e-6);
    }
}

struct EllipsoidCase {
    std::vector<double> params;
    Vec wo, wi;
    double d_n, d_h, g1_o, g1_i, f, p_h, p_o; // negative: not known
};
const EllipsoidCase kEllipsoids[] = {{{.5, .5, 0, 0, 0},
                                      kUp,
                                      unit({.3, .2, .9}),
                                      1.27323954,
                                      1.03790804,
                                      -1,
                                      .99016546,
                                      .27677578,
                                      1.01912822,
                                      .25947701},
                                     {{.3, .6, 0, 0, 0},
                                      unit({.5, -.2, .7}),
                                      unit({-.3, .4, .8}),
                                      1.76838826,
                                      1.13572709,
                                      .98185065,
                                      .97557435,
                                      .40464490,
                                      1.17545831,
                                      .35172941},
                                     {{.2, .6, .25, -.3, .7},
                                      unit({.6, .3, .4}),
                                      unit({-.2, .1, .9}),
                                      .27689016,
                                      .65741958,
                                      .61994494,
                                      1,
                                      .20499695,
                                      .65930406,
                                      .19894851},
                                     {{.2, .6, .25, -.3, .7},
                                      unit({-.6, -.3, .4}),
                                      unit({.2, -.1, .9}),
                                      -1,
                                      .15595392,
                                      1,
                                      .92419292,
                                      .07249542,
                                      .29621431,
                                      .08938424},
                                     {{.7, .15, -.4, .2, 1.9},
                                      unit({0, .9, .1}),
                                      unit({.1, -.5, .8}),
                                      .06099933,
                                      .09704133,
                                      .19451614,
                                      -1,
                                      .05067463,
                                      -1,
                                      .04273260}};

TEST(EllipsoidVectors, distribution_masking_brdf_and_densities_are_known)
{
    for (const EllipsoidCase& c : kEllipsoids) {
        const auto of = [&](const char* name, Vec w) {
            std::vector<double> in = c.params;
            in.insert(in.end(), w.begin(), w.end());
            return call(oracle_fns(), name, in)[0];
        };
        const auto expect = [](double a, double known) {
            if (known >= 0) {
                EXPECT_NEAR(a, known, 2e-8);
            }
        };
        expect(of("ellipsoid_d", kUp), c.d_n);
        expect(of("ellipsoid_d", unit(c.wo + c.wi)), c.d_h);
        expect(of("ellipsoid_g1", c.wo), c.g1_o);
        expect(of("ellipsoid_g1", c.wi), c.g1_i);
        expect(eval("ellipsoid", c.params, c.wo, c.wi), c.f);
        expect(half_pdf("ellipsoid", c.params, c.wo, c.wi), c.p_h);
        expect(value("ellipsoid", true, c.params, c.wo, c.wi), c.p_o);
    }
    const EllipsoidCase& lit = kEllipsoids[3]; // the view's minimum is at work
    std::vector<double> in = lit.params;
    in.insert(in.end(), lit.wo.begin(), lit.wo.end());
    EXPECT_NEAR(call(oracle_fns(), "ellipsoid_k", in)[0] * lit.wo[2], 1.17413963, 2e-8);
}

TEST(EllipsoidVectors, visible_normals_and_weights_are_known)
{
    struct Case {
        std::size_t ellipsoid;
        double x, y;
        Vec m;
        double weight;
    };
    const Case cases[] = {{0, .3, .8, {-.17556172, .30408182, .93632918}, .95645244},
                          {1, .5, .5, {.05943914, -.09510263, .99369134}, .99330977},
                          {1, .9, .3, {-.08644431, .41479305, .90580026}, .64019609},
                          {2, .1, .6, {.74009509, .55691856, .37696283}, .38607045},
                          {3, .25, .25, {-.27451695, -.72474222, .63197244}, .62149939},
                          {4, .7, .05, {-.47130045, .40392274, .78404229}, .83308077}};
    for (const Case& c : cases) {
        const EllipsoidCase& e = kEllipsoids[c.ellipsoid];
        std::vector<double> in = e.params;
        in.insert(in.end(), e.wo.begin(), e.wo.end());
        in.insert(in.end(), {c.x, c.y});
        const std::vector<double> m = call(oracle_fns(), "ellipsoid_normal", in);
        expect_near({m[0], m[1], m[2]}, c.m, 2e-8);
        EXPECT_NEAR(sample("ellipsoid", e.params, e.wo, c.x, c.y).weight, c.weight, 2e-8);
    }
    expect_near(sample("ellipsoid", kEllipsoids[1].params, kEllipsoids[1].wo, .5, .5).wi,
                {-.46595015, .06615402, .88233446}, 2e-8);
    expect_near(sample("ellipsoid", kEllipsoids[2].params, kEllipsoids[2].wo, .1, .6).wi,
                {.67575711, .70247726, .22333389}, 2e-8);
}

TEST(EllipsoidVectors, tilts_move_the_commonest_normal)
{
    const std::vector<double> x = call(oracle_fns(), "ellipsoid_peak", {.3, .3, .2, 0, 0});
    expect_near({x[0], x[1], x[2]}, {0, .19866933, .98006658}, 1e-8);
    const std::vector<double> y = call(oracle_fns(), "ellipsoid_peak", {.3, .3, 0, .2, 0});
    expect_near({y[0], y[1], y[2]}, {-.19866933, 0, .98006658}, 1e-8);
}

// .14 of the samples; accepted they would give an albedo of .858 (quadrature in double of the paper's formulas, 3000^2 half vectors).
TEST(EllipsoidVectors, directions_below_the_horizon_reflect_nothing)
{
    const Setting setting = {{.3, .5, 0, 0, 0, 0}, {.3, .5}};
    EXPECT_NEAR(albedo("ellipsoid", setting, direction(.9, 0), 512), .74060, 5e-4);
    EXPECT_NEAR(albedo("ellipsoid", setting, direction(.9, 1), 512), .75235, 5e-4);
    EXPECT_NEAR(integral(model_case("ellipsoid"), setting, direction(.9, 0), Integrand::pdf, 512), 1 - .1437, 5e-4);
    EXPECT_EQ(eval("ellipsoid", {.3, .5, .3, .2, 0}, unit({.5, 0, .5}), unit({-.5, 0, -.1})), 0);
    EXPECT_EQ(eval("ellipsoid", {.3, .5, .3, .2, 0}, unit({.5, 0, -.5}), unit({-.5, 0, .1})), 0);
}

// The normals' areas add up to the surface's; those that u sees, times G1, cover no more than the surface that u sees, and all of
// it unless G1's minimum is at work, which is nowhere on an upright ellipsoid.
TEST(EllipsoidVectors, masking_leaves_the_projected_area)
{
    int limited = 0;
    for (const EllipsoidCase& c : kEllipsoids) {
        constexpr std::size_t kGrid = 600, kCount = kGrid * kGrid;
        const OtherFn& d = other(oracle_fns(), "ellipsoid_d");
        std::vector<double> in(8 * kCount), value(kCount), measure(kCount);
        const Chart chart{kUp, true, 1, {.7, .7}};
        for (std::size_t k = 0; k < kCount; ++k) {
            const Chart::Point p = chart.at((static_cast<double>(k / kGrid) + .5) / kGrid, (static_cast<double>(k % kGrid) + .5) / kGrid);
            for (std::size_t i = 0; i < 8; ++i)
                in[i * kCount + k] = i < 5 ? c.params[i] : p.h[i - 5];
            measure[k] = p.per_h / kCount;
        }
        d.run(kCount, in.data(), value.data());
        double area = 0;
        for (std::size_t k = 0; k < kCount; ++k)
            area += value[k] * measure[k] * in[7 * kCount + k];
        EXPECT_NEAR(area, 1, 1e-4);
        for (Vec u : {c.wo, c.wi, unit({.8, -.5, .2}), unit({-.9, .1, .1})}) {
            const std::vector<double> at = {c.params[0], c.params[1], c.params[2], c.params[3], c.params[4], u[0], u[1], u[2]};
            const double g1 = call(oracle_fns(), "ellipsoid_g1", at)[0];
            const bool minimum = call(oracle_fns(), "ellipsoid_k", at)[0] * u[2] > 1 + 1e-12;
            double seen = 0;
            for (std::size_t k = 0; k < kCount; ++k)
                seen += value[k] * measure[k] * std::max(dot(u, {in[5 * kCount + k], in[6 * kCount + k], in[7 * kCount + k]}), 0.0);
            EXPECT_LE(g1 * seen, u[2] * (1 + 1e-3));
            if (!minimum) {
                EXPECT_NEAR(g1 * seen, u[2], 1e-3 * u[2]);
            }
            limited += minimum;
            EXPECT_FALSE(minimum && c.params[2] == 0 && c.params[3] == 0);
        }
    }
    EXPECT_GT(limited, 0);
}

// Walter et al. 2007: f(wo, wi) / eta(wi's side)^2 is symmetric, where f is the density of scattered power.
TEST(DielectricVectors, refraction_is_reciprocal_up_to_the_square_of_the_index)
{
    Random random(21);
    const std::vector<double> params = {.4, .3, -.15, .2, 1.9, 1.5};
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec above = unit(random.hemisphere()), below = unit(random.hemisphere()) * -1;
        const double down = eval("ellipsoid_dielectric", params, above, below) / (1.5 * 1.5);
        const double up = eval("ellipsoid_dielectric", params, below, above);
        ASSERT_NEAR(down, up, 1e-9 * (down + up));
        largest = std::max(largest, down);
    }
    EXPECT_GT(largest, 0.1);
}

TEST(DielectricVectors, reflection_is_the_ellipsoids_times_fresnel)
{
    const std::vector<double> shape = {.2, .6, .25, -.3, .7};
    std::vector<double> params = shape;
    params.push_back(1.5);
    for (const Pair& p : kPairs) {
        const double f = call(oracle_fns(), "fresnel_dielectric", {dot(p.v, unit(p.v + p.l)), 1.5})[0];
        EXPECT_NEAR(eval("ellipsoid_dielectric", params, p.v, p.l), f * eval("ellipsoid", shape, p.v, p.l),
                    1e-12);
    }
}

TEST(DielectricVectors, a_nearly_smooth_interface_obeys_snell)
{
    const Vec wo = direction(.7, 0);
    std::vector<double> params = {.001, .001, 0, 0, 0, 1.5};
    Batch batch(params, 1);
    batch.set(0, wo, {.5, .5, .9});
    const auto s =
        batch.run(oracle_fns().models[model_case("ellipsoid_dielectric").index].sample, kSampleOutputs);
    EXPECT_NEAR(s[0], -wo[0] / 1.5, 1e-3);
    EXPECT_LT(s[2], 0);
    EXPECT_EQ(s[6], 1);
}

} // namespace
} // namespace burnish::test
