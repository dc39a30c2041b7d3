// Known values and laws for the ellipsoid distribution and its dielectric.
#include <cmath>
#include <gtest/gtest.h>

#include "tests/unit/models/point.h"

namespace burnish::test {
namespace {

struct EllipsoidCase {
    std::vector<double> params;
    Vec wo, wi;
    double d_n, d_h, g1_o, g1_i, f, p_h, p_o; // negative: not known
};
const EllipsoidCase kEllipsoids[] = {
    {{.5, .5, 0, 0, 0}, kUp, unit({.3, .2, .9}), 1.27323954, 1.03790804, -1, .99016546, .27677578, 1.01912822, .25947701},
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
    {{.2, .6, .25, -.3, .7}, unit({.6, .3, .4}), unit({-.2, .1, .9}), .27689016, .65741958, .61994494, 1, .20499695, .65930406, .19894851},
    {{.2, .6, .25, -.3, .7}, unit({-.6, -.3, .4}), unit({.2, -.1, .9}), -1, .15595392, 1, .92419292, .07249542, .29621431, .08938424},
    {{.7, .15, -.4, .2, 1.9}, unit({0, .9, .1}), unit({.1, -.5, .8}), .06099933, .09704133, .19451614, -1, .05067463, -1, .04273260}};

TEST(ellipsoid_vectors, distribution_masking_brdf_and_densities_are_known)
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
    const EllipsoidCase& lit = kEllipsoids[3]; // the view's minimum limits G1
    std::vector<double> in = lit.params;
    in.insert(in.end(), lit.wo.begin(), lit.wo.end());
    EXPECT_NEAR(call(oracle_fns(), "ellipsoid_k", in)[0] * lit.wo[2], 1.17413963, 2e-8);
}

// Derives the height-correlated G2 from both directions' G1, including cases where a minimum limits G1.
TEST(ellipsoid_vectors, correlated_masking_follows_from_that_of_either_direction)
{
    for (const EllipsoidCase& c : kEllipsoids) {
        const auto g1 = [&](Vec w) {
            std::vector<double> in = c.params;
            in.insert(in.end(), w.begin(), w.end());
            return call(oracle_fns(), "ellipsoid_g1", in)[0];
        };
        const double o = g1(c.wo), i = g1(c.wi), correlated = 1 / (1 / o + 1 / i - 1);
        EXPECT_NEAR(eval("ellipsoid_correlated", c.params, c.wo, c.wi), eval("ellipsoid", c.params, c.wo, c.wi) * correlated / (o * i),
                    1e-12);
        EXPECT_GE(correlated, o * i * (1 - 1e-12));
    }
}

TEST(ellipsoid_vectors, visible_normals_and_weights_are_known)
{
    struct Case {
        std::size_t ellipsoid;
        double x, y;
        Vec m;
        double weight;
    };
    const Case cases[] = {
        {0, .3, .8, {-.17556172, .30408182, .93632918}, .95645244},    {1, .5, .5, {.05943914, -.09510263, .99369134}, .99330977},
        {1, .9, .3, {-.08644431, .41479305, .90580026}, .64019609},    {2, .1, .6, {.74009509, .55691856, .37696283}, .38607045},
        {3, .25, .25, {-.27451695, -.72474222, .63197244}, .62149939}, {4, .7, .05, {-.47130045, .40392274, .78404229}, .83308077}};
    for (const Case& c : cases) {
        const EllipsoidCase& e = kEllipsoids[c.ellipsoid];
        std::vector<double> in = e.params;
        in.insert(in.end(), e.wo.begin(), e.wo.end());
        in.insert(in.end(), {c.x, c.y});
        const std::vector<double> m = call(oracle_fns(), "ellipsoid_normal", in);
        expect_near({m[0], m[1], m[2]}, c.m, 2e-8);
        EXPECT_NEAR(sample("ellipsoid", e.params, e.wo, c.x, c.y).weight, c.weight, 2e-8);
    }
    expect_near(sample("ellipsoid", kEllipsoids[1].params, kEllipsoids[1].wo, .5, .5).wi, {-.46595015, .06615402, .88233446}, 2e-8);
    expect_near(sample("ellipsoid", kEllipsoids[2].params, kEllipsoids[2].wo, .1, .6).wi, {.67575711, .70247726, .22333389}, 2e-8);
}

TEST(ellipsoid_vectors, tilts_move_the_commonest_normal)
{
    const std::vector<double> x = call(oracle_fns(), "ellipsoid_peak", {.3, .3, .2, 0, 0});
    expect_near({x[0], x[1], x[2]}, {0, .19866933, .98006658}, 1e-8);
    const std::vector<double> y = call(oracle_fns(), "ellipsoid_peak", {.3, .3, 0, .2, 0});
    expect_near({y[0], y[1], y[2]}, {-.19866933, 0, .98006658}, 1e-8);
}

// A part .14 of the samples lies below the horizon; accepted, they would give an albedo of .858. Expected values are double-precision
// quadratures of the paper's formulas (3000^2 half vectors).
TEST(ellipsoid_vectors, directions_below_the_horizon_reflect_nothing)
{
    const Setting setting = {{.3, .5, 0, 0, 0, 0}, {.3, .5}};
    EXPECT_NEAR(albedo("ellipsoid", setting, direction(.9, 0), 512), .74060, 5e-4);
    EXPECT_NEAR(albedo("ellipsoid", setting, direction(.9, 1), 512), .75235, 5e-4);
    EXPECT_NEAR(integral(model_case("ellipsoid"), setting, direction(.9, 0), Integrand::pdf, 512), 1 - .1437, 5e-4);
    EXPECT_EQ(eval("ellipsoid", {.3, .5, .3, .2, 0}, unit({.5, 0, .5}), unit({-.5, 0, -.1})), 0);
    EXPECT_EQ(eval("ellipsoid", {.3, .5, .3, .2, 0}, unit({.5, 0, -.5}), unit({-.5, 0, .1})), 0);
}

// The projected areas of the normals add up to the surface's area. The areas visible from u, times G1, equal the surface's projected area,
// or less where G1's minimum applies. The minimum never applies to an upright ellipsoid.
TEST(ellipsoid_vectors, masking_leaves_the_projected_area)
{
    int limited = 0;
    for (const EllipsoidCase& c : kEllipsoids) {
        constexpr std::size_t kGrid = 600, kCount = kGrid * kGrid;
        std::vector<double> in(8 * kCount), measure(kCount);
        const Chart chart{kUp, true, 1, {.7, .7}};
        for (std::size_t k = 0; k < kCount; ++k) {
            const Chart::Point p = chart.at((static_cast<double>(k / kGrid) + .5) / kGrid, (static_cast<double>(k % kGrid) + .5) / kGrid);
            for (std::size_t i = 0; i < 8; ++i)
                in[i * kCount + k] = i < 5 ? c.params[i] : p.h[i - 5];
            measure[k] = p.per_h / kCount;
        }
        const std::vector<double> value = call(oracle_fns(), "ellipsoid_d", in);
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
TEST(dielectric_vectors, refraction_is_reciprocal_up_to_the_square_of_the_index)
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

TEST(dielectric_vectors, reflection_is_the_ellipsoids_times_fresnel)
{
    const std::vector<double> shape = {.2, .6, .25, -.3, .7};
    std::vector<double> params = shape;
    params.push_back(1.5);
    for (const Pair& p : kPairs) {
        const double f = call(oracle_fns(), "fresnel_dielectric", {dot(p.v, unit(p.v + p.l)), 1.5})[0];
        EXPECT_NEAR(eval("ellipsoid_dielectric", params, p.v, p.l), f * eval("ellipsoid", shape, p.v, p.l), 1e-12);
    }
}

TEST(dielectric_vectors, a_nearly_smooth_interface_obeys_snell)
{
    const Vec wo = direction(.7, 0);
    std::vector<double> params = {.001, .001, 0, 0, 0, 1.5};
    Batch batch(params, 1);
    batch.set(0, wo, {.5, .5, .9});
    const auto s = batch.run(fns_of(oracle_fns(), model_case("ellipsoid_dielectric")).sample);
    EXPECT_NEAR(s[0], -wo[0] / 1.5, 1e-3);
    EXPECT_LT(s[2], 0);
    EXPECT_EQ(s[6], 1);
}

} // namespace
} // namespace burnish::test
