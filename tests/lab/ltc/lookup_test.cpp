// The run-time lookup, against the table in double and against the original lobes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/node_fit.h"
#include "tests/unit/adversary/lit.h"

namespace burnish::ltc {
namespace {

Row looked_at(const test::IsaFns& isa, const Vec& eye, double alpha_x, double alpha_y)
{
    return run_row(isa, "ltc_lookup", {eye.x, eye.y, eye.z, alpha_x, alpha_y}, shipped_view());
}

Vec eye_at(double theta, double phi)
{
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Returns a matrix of equal density with a positive determinant.
Matrix unmirrored(Matrix m)
{
    if (determinant(m) < 0.0)
        m[1] = -m[1], m[4] = -m[4], m[7] = -m[7];
    return m;
}

TEST(lookup, in_the_tables_quadrant_is_the_tables_own)
{
    Chance chance;
    for (int i = 0; i < 500; ++i) {
        const Place p = {chance.from(0.0, 1.55), chance.from(0.0, 1.57), chance.from(0.002, 2.0), chance.from(0.02, 1.0)};
        const Row got = looked_at(test::oracle_fns(), eye_at(p.theta, p.phi), p.alpha, p.alpha * p.lambda);
        const Looked expected = lookup(halves(), p);
        const Row m = columns(expected.m);
        for (std::size_t e = 0; e < 9; ++e)
            ASSERT_NEAR(got[e], m[e], 4e-6) << i << " " << e;
        ASSERT_NEAR(got[10], std::min(expected.all, 1.0), 1e-6);
        ASSERT_NEAR(got[11], expected.grazing, 1e-6);
    }
}

TEST(lookup, every_quadrant_and_order_of_widths_has_its_own_lobe)
{
    const Rule rule(15), white(18);
    for (const Place& place : {Place{0.9, 0.6, 0.4, 0.3}, Place{0.5, 1.2, 0.7, 0.2}, Place{1.1, 0.3, 0.2, 0.5}}) {
        const double alone = l1_distance(LobePoints(normalised_lobe(place, white), rule), lookup(halves(), place).m);
        for (const bool swap : {false, true})
            for (const auto& [sx, sy] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
                Lobe lobe = normalised_lobe(place, white); // the requested lobe, mirrored itself
                if (swap) {
                    std::swap(lobe.v.x, lobe.v.y);
                    std::swap(lobe.alpha_x, lobe.alpha_y);
                }
                lobe.v.x *= sx, lobe.v.y *= sy;
                for (const test::IsaFns& isa : test::all_fns()) {
                    const Row got = looked_at(isa, lobe.v, lobe.alpha_x, lobe.alpha_y);
                    const Matrix m = from_columns(got);
                    EXPECT_NEAR(l1_distance(LobePoints(lobe, rule), unmirrored(m)), alone, 0.012) << swap << sx << sy << isa.name;
                    EXPECT_NEAR(got[9], determinant(m), 1e-6) << isa.name;
                    EXPECT_EQ(got[9] < 0.0, (sx * sy < 0.0) != swap) << swap << sx << sy << isa.name;
                }
            }
    }
}

TEST(lookup, equal_widths_are_not_exchanged)
{
    for (const test::IsaFns& isa : test::all_fns())
        EXPECT_GT(looked_at(isa, eye_at(0.7, 0.4), 0.3, 0.3)[9], 0.0) << isa.name; // swapping the axes mirrors
}

TEST(lookup, along_the_normal_all_azimuths_are_one)
{
    for (const test::IsaFns& isa : test::all_fns())
        for (const double tilt : {0.0, 1e-7, 3e-6}) {
            const Matrix first = inverse(from_columns(looked_at(isa, {tilt, 0.0, 1.0}, 0.5, 0.2)));
            for (int turn = 1; turn < 24; ++turn) {
                const double phi = turn * (kPi / 12.0);
                const Matrix n = inverse(from_columns(looked_at(isa, {tilt * std::cos(phi), tilt * std::sin(phi), 1.0}, 0.5, 0.2)));
                Chance chance;
                for (int k = 0; k < 20; ++k) {
                    const Vec l = chance.upper();
                    const double q = transformed_cosine(first, l);
                    EXPECT_NEAR(transformed_cosine(n, l), q, 1e-4 * std::max(q, 1.0)) << isa.name << tilt << turn;
                }
            }
        }
}

double seen(const Vec& eye, double alpha_x, double alpha_y)
{
    const Row quad = flat({{-0.6, -0.5, 0.4}, {0.5, -0.6, 0.5}, {0.6, 0.7, 0.7}, {-0.5, 0.6, 0.6}});
    return run_row(test::fast_fns(), "ltc_quad_seen", joined({{eye.x, eye.y, eye.z, alpha_x, alpha_y}, quad}), shipped_view())[0];
}

TEST(lookup, has_no_step_where_it_mirrors_or_exchanges_or_ends)
{
    const double e = 1e-4;
    for (const double theta : {0.2, 0.7, 1.1, 1.4})
        for (int quarter = 0; quarter < 4; ++quarter) {
            const double phi = quarter * 0.5 * kPi;
            EXPECT_NEAR(seen(eye_at(theta, phi - e), 0.4, 0.2), seen(eye_at(theta, phi + e), 0.4, 0.2), 1e-3) << theta << quarter;
            EXPECT_NEAR(seen(eye_at(theta, phi + 0.4), 0.3 - e, 0.3), seen(eye_at(theta, phi + 0.4), 0.3 + e, 0.3), 1e-3)
                << theta << quarter;
            for (const double alpha : {0.002, 1.0 / 49.0, 1.0, 2.0})
                EXPECT_NEAR(seen(eye_at(theta, phi + 0.4), alpha - 1e-6, 0.008), seen(eye_at(theta, phi + 0.4), alpha + 1e-6, 0.008), 1e-3);
        }
}

// Mean L1 distance between looked-up and exact lobes, and relative error of the albedo.
struct Off {
    double l1 = 0.0, albedo = 0.0;
};
Off mean_off(const std::vector<double>& alphas)
{
    const Rule rule(15), white(18);
    Off off;
    std::vector<Place> places;
    for (const double alpha : alphas)
        for (const double theta : {0.2, 0.7, 1.1})
            for (const double lambda : {0.3, 0.8})
                places.push_back({theta, 0.7, alpha, lambda});
    for (const Place& place : places) {
        const Row got = looked_at(test::oracle_fns(), eye_at(place.theta, place.phi), place.alpha, place.alpha * place.lambda);
        const double all = albedo(Lobe(place), white).all, share = 1.0 / static_cast<double>(places.size());
        off.l1 += share * l1_distance(LobePoints(normalised_lobe(place, white), rule), from_columns(got));
        off.albedo += share * std::abs(got[10] / all - 1.0);
    }
    printf("L1 %.4f, albedo %.4f\n", off.l1, off.albedo);
    return off;
}

TEST(lookup, narrow_lobes_are_near_the_ones_they_stand_for)
{
    const Off off = mean_off({0.002, 0.005, 0.01, 1.0 / 49.0, 0.03, 0.045});
    EXPECT_LT(off.l1, 0.03);
    EXPECT_LT(off.albedo, 0.002);
}

TEST(lookup, lobes_wider_than_one_are_near_the_ones_they_stand_for)
{
    const Off off = mean_off({1.1, 1.3, 1.46, 1.7, 2.0});
    EXPECT_LT(off.l1, 0.1);
    EXPECT_LT(off.albedo, 0.013);
}

TEST(lookup, round_lobes_are_the_round_table_s_turned_to_the_eye)
{
    Chance chance;
    const Rule rule(15), white(18);
    for (int i = 0; i < 300; ++i) {
        const Place p = {chance.from(0.0, 1.55), chance.from(0.0, 1.57), chance.from(0.002, 1.0), 1.0};
        const double sx = i & 1 ? 1.0 : -1.0, sy = i & 2 ? 1.0 : -1.0;
        const Vec eye = eye_at(p.theta, p.phi);
        const Looked expected = lookup(round_halves(), p);
        for (const test::IsaFns& isa : {test::oracle_fns(), test::fast_fns()}) {
            const Row got = run_row(isa, "ltc_round_lookup", {sx * eye.x, sy * eye.y, eye.z, p.alpha}, round_view());
            const Matrix m = Matrix{sx, 0.0, 0.0, 0.0, sy, 0.0, 0.0, 0.0, 1.0} * from_columns(got); // another gauge of this lobe
            for (int k = 0; k < 5; ++k) {
                const Vec l = chance.upper();
                const double q = transformed_cosine(inverse(expected.m), l);
                ASSERT_NEAR(transformed_cosine(inverse(m), l), q, 2e-3 * std::max(q, 0.1)) << isa.name << i;
            }
            ASSERT_NEAR(got[10], expected.all, 1e-5);
        }
        if (i % 10 == 0 && p.theta < 1.4) {
            EXPECT_LT(l1_distance(LobePoints(normalised_lobe(p, white), rule), expected.m), 0.35) << p.theta << " " << p.alpha;
        }
    }
}

TEST(lookup, without_a_matrix_in_the_table_the_natural_one_stands_in)
{
    const std::vector<std::uint16_t> nothing(3 * 4 * 4096, 0);
    test::TexelView t;
    t.texels = nothing.data(), t.levels = 8;
    for (const int held : {0, 1, 2, 5, 8}) {
        t.level = held;
        for (const test::IsaFns& isa : test::all_fns()) {
            const Place place = {0.8, 0.5, 0.5, 0.4};
            const Vec v = eye_at(place.theta, place.phi);
            const Row got = run_row(isa, "ltc_lookup", {v.x, v.y, v.z, 0.5, 0.2}, t), m = columns(natural_matrix(place));
            for (std::size_t e = 0; e < 9; ++e)
                EXPECT_NEAR(got[e], m[e], 1e-6) << isa.name << e;
            EXPECT_EQ(got[10], 0.0);
        }
    }
}

TEST(lookup, of_what_is_outside_is_defined)
{
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const test::IsaFns& isa : test::all_fns())
        for (const Row& row :
             {Row{nan, nan, nan, nan, nan}, Row{inf, -inf, inf, inf, inf}, Row{0.0, 0.0, 0.0, 0.0, 0.0}, Row{0.6, 0.0, -0.8, 0.5, 0.5},
              Row{0.0, 0.0, -1.0, 1.9, 0.1}, Row{1.0, 0.0, 0.0, -1.0, 1e-30}, Row{0.7, 0.7, 0.1, 1e30, 0.3}}) {
            const Row got = run_row(isa, "ltc_lookup", row, shipped_view());
            for (const double x : got)
                EXPECT_TRUE(std::isfinite(x)) << isa.name;
            EXPECT_GT(std::abs(got[9]), 1e-9) << isa.name;
        }
    const Row border = looked_at(test::fast_fns(), {std::sqrt(1.0 - 0.0004), 0.0, 0.02}, 0.5, 0.5);
    const Row below = looked_at(test::fast_fns(), {0.8, 0.0, -0.6}, 0.5, 0.5);
    for (std::size_t e = 0; e < 12; ++e)
        EXPECT_NEAR(below[e], border[e], 1e-5);
}

TEST(lookup, gauges_are_one_density_and_one_light)
{
    Chance chance;
    for (int i = 0; i < 200; ++i) {
        const Matrix m = chance.lobe(0.1, 0.1);
        const double turn = chance.from(-3.0, 3.0), c = std::cos(turn), s = std::sin(turn), flip = i % 2 ? 1.0 : -1.0;
        const Matrix other = m * Matrix{c, -s * flip, 0.0, s, c * flip, 0.0, 0.0, 0.0, 1.0};
        const Vec l = chance.upper();
        const double q = run_row(test::oracle_fns(), "ltc_density", joined({columns(m), flat({l})}))[0];
        EXPECT_NEAR(run_row(test::oracle_fns(), "ltc_density", joined({columns(other), flat({l})}))[0], q, 1e-12 * std::max(q, 1.0));
        EXPECT_NEAR(q, transformed_cosine(inverse(m), l), 1e-12 * std::max(q, 1.0));
        const Row quad = flat({chance.point(1.0), chance.point(1.0), chance.point(1.0)});
        EXPECT_NEAR(run_row(test::oracle_fns(), "ltc_triangle", joined({columns(m), quad}))[0],
                    run_row(test::oracle_fns(), "ltc_triangle", joined({columns(other), quad}))[0], 1e-6);
    }
}

} // namespace
} // namespace burnish::ltc
