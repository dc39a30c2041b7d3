// Polygon lights at run time: against the fit's polygons in double, against sums and limits, and in hard cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/polygon.h"
#include "tests/unit/adversary/lit.h"

namespace burnish::ltc {
namespace {

using test::all_fns;
using test::fast_fns;
using test::float_fns;
using test::IsaFns;
using test::oracle_fns;

std::vector<Vec> parallelogram_of(const Vec& middle, const Vec& a, const Vec& b)
{
    return {along(middle, -1.0, a, -1.0, b), along(middle, 1.0, a, -1.0, b), along(middle, 1.0, a, 1.0, b), along(middle, -1.0, a, 1.0, b)};
}

double part(const IsaFns& isa, const char* name, const Matrix& m, const std::vector<Vec>& corners)
{
    return run_row(isa, name, joined({columns(m), flat(corners)}))[0];
}

// Returns a matrix and a parallelogram in general position, rounded to floats.
Row any_quad(Chance& chance, double least_alpha, double least_lambda)
{
    const Matrix m = chance.lobe(least_alpha, least_lambda);
    const Vec middle = chance.point(1.5), a = chance.point(0.9), b = chance.point(0.9);
    return rounded(joined({columns(m), flat(parallelogram_of(middle, a, b))}));
}

double by_the_fit(const Row& row)
{
    std::vector<Vec> corners;
    for (std::size_t i = 9; i < row.size(); i += 3)
        corners.push_back({row[i], row[i + 1], row[i + 2]});
    return polygon_part(inverse(from_columns(row)), corners);
}

TEST(light, polygons_are_the_fits_own)
{
    Chance chance;
    std::vector<Row> rows;
    for (int i = 0; i < 3000; ++i)
        rows.push_back(any_quad(chance, 0.01, 0.1));
    const std::vector<Row> exact = run_rows(oracle_fns(), "ltc_quad", rows);
    double lit = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        ASSERT_NEAR(exact[i][0], by_the_fit(rows[i]), 1e-6) << i;
        lit += exact[i][0];
        ASSERT_NEAR(exact[i][0], exact[i][3], 1e-12);
    }
    EXPECT_GT(lit / static_cast<double>(rows.size()), 0.05);
}

// Tests round polygons of 16 corners, too.
TEST(light, sixteen_corners_are_the_fits_own)
{
    Chance chance;
    std::vector<Row> rows;
    for (int i = 0; i < 500; ++i) {
        const Vec middle = chance.point(1.0), a = chance.point(0.9), b = chance.point(0.9);
        std::vector<Vec> corners;
        for (int k = 0; k < 16; ++k)
            corners.push_back(along(middle, std::cos(k * kPi / 8.0), a, std::sin(k * kPi / 8.0), b));
        rows.push_back(rounded(joined({columns(chance.lobe(0.03, 0.1)), flat(corners)})));
    }
    for (const IsaFns& isa : all_fns()) {
        const std::vector<Row> got = run_rows(isa, "ltc_polygon16", rows);
        for (std::size_t i = 0; i < rows.size(); ++i)
            ASSERT_NEAR(got[i][0], by_the_fit(rows[i]), &isa == &all_fns().back() ? 2e-6 : 2e-4) << isa.name << i;
    }
}

TEST(light, floats_are_near_doubles_down_to_narrow_lobes)
{
    Chance chance;
    for (const auto& [alpha, bound] : {std::pair{0.2, 2e-5}, {0.01, 2e-4}}) {
        std::vector<Row> rows;
        for (int i = 0; i < 20000; ++i)
            rows.push_back(any_quad(chance, alpha, 0.1));
        const std::vector<Row> exact = run_rows(oracle_fns(), "ltc_quad", rows), got = run_rows(fast_fns(), "ltc_quad", rows);
        double worst = 0.0;
        for (std::size_t i = 0; i < rows.size(); ++i)
            worst = std::max(worst, std::abs(got[i][0] - exact[i][0]));
        EXPECT_LT(worst, bound) << alpha;
        printf("alpha from %g: float against double %.2e\n", alpha, worst);
    }
}

// Tests lookup and light together.
TEST(light, floats_are_near_doubles_with_their_lookup)
{
    Chance chance;
    std::vector<Row> rows;
    for (int i = 0; i < 20000; ++i) {
        const Vec eye = chance.upper(), middle = chance.point(1.5), a = chance.point(0.9), b = chance.point(0.9);
        const double alpha = std::pow(0.01, chance.from(0.0, 1.0));
        rows.push_back(
            rounded(joined({{eye.x, eye.y, eye.z, alpha, alpha * chance.from(0.1, 1.0)}, flat(parallelogram_of(middle, a, b))})));
    }
    const std::vector<Row> exact = run_rows(oracle_fns(), "ltc_quad_seen", rows, shipped_view());
    const std::vector<Row> got = run_rows(fast_fns(), "ltc_quad_seen", rows, shipped_view());
    double worst = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i)
        worst = std::max(worst, std::abs(got[i][0] - exact[i][0]));
    EXPECT_LT(worst, 2e-4);
    printf("with the lookup: %.2e\n", worst);
}

TEST(light, five_sides_of_a_room_take_what_does_not_leak)
{
    Chance chance;
    for (int i = 0; i < 100; ++i) {
        const Matrix m = chance.lobe(0.05, 0.1);
        const double s = 2.0, h = 1.5;
        const std::vector<std::vector<Vec>> sides = {{{-s, -1.0, h}, {1.0, -1.0, h}, {1.0, s, h}, {-s, s, h}},
                                                     {{-s, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, -1.0, h}, {-s, -1.0, h}},
                                                     {{-s, s, 0.0}, {1.0, s, 0.0}, {1.0, s, h}, {-s, s, h}},
                                                     {{-s, -1.0, 0.0}, {-s, s, 0.0}, {-s, s, h}, {-s, -1.0, h}},
                                                     {{1.0, -1.0, 0.0}, {1.0, s, 0.0}, {1.0, s, h}, {1.0, -1.0, h}}};
        // The surface's horizon is a plane in the cosine's space. A plane that leans by an angle has (1 + cos) / 2 above it.
        const double above = 0.5 * (1.0 + m[8] / std::sqrt(m[6] * m[6] + m[7] * m[7] + m[8] * m[8]));
        for (const IsaFns& isa : all_fns()) {
            double sum = 0.0;
            for (const std::vector<Vec>& side : sides)
                sum += part(isa, "ltc_quad", m, side);
            EXPECT_NEAR(sum, above, 1e-5) << isa.name << i;
        }
    }
}

// Clips a polygon by Sutherland and Hodgman's algorithm, in double precision.
std::vector<Vec> cut(const std::vector<Vec>& corners, const Vec& normal)
{
    std::vector<Vec> above;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const double ha = dot(a, normal), hb = dot(b, normal);
        if (ha > 0.0)
            above.push_back(a);
        if ((ha > 0.0) != (hb > 0.0))
            above.push_back(along(a, ha / (ha - hb), b, -ha / (ha - hb), a));
    }
    return above;
}

TEST(light, quads_are_cut_at_a_plane_that_leans)
{
    Chance chance;
    int cuts = 0, below = 0;
    for (int i = 0; i < 400; ++i) {
        const Matrix m = chance.lobe(0.05, 0.1);
        const Vec middle = chance.point(1.0), a = chance.point(0.9), b = chance.point(0.9), normal = unit(chance.point(1.0));
        const std::vector<Vec> corners = parallelogram_of(middle, a, b), left = cut(corners, normal);
        cuts += !left.empty() && left.size() != 4, below += left.empty();
        const double expected = left.empty() ? 0.0 : polygon_part(inverse(m), left);
        for (const IsaFns& isa : all_fns()) {
            const Row got = run_row(isa, "ltc_quad_above", joined({columns(m), flat(corners), flat({normal})}));
            ASSERT_NEAR(got[0], expected, 1e-4) << isa.name << i;
            if (left.empty()) {
                ASSERT_NEAR(got[1], 0.0, 1e-6) << isa.name << i;
            }
        }
    }
    EXPECT_GT(cuts, 50);
    EXPECT_GT(below, 20);
}

TEST(light, parts_of_a_quad_sum_to_it)
{
    Chance chance;
    for (int i = 0; i < 200; ++i) {
        const Matrix m = i % 4 ? chance.lobe(0.1, 0.1) : kCosine;
        const Vec middle = chance.point(1.0), a = chance.point(0.9), b = chance.point(0.9);
        const double s = chance.from(-0.8, 0.8), t = chance.from(-0.8, 0.8);
        for (const IsaFns& isa : {oracle_fns(), fast_fns()}) {
            double sum = 0.0;
            for (const auto& [s0, s1] : {std::pair{-1.0, s}, {s, 1.0}})
                for (const auto& [t0, t1] : {std::pair{-1.0, t}, {t, 1.0}})
                    sum += part(isa, "ltc_quad", m,
                                {along(middle, s0, a, t0, b), along(middle, s1, a, t0, b), along(middle, s1, a, t1, b),
                                 along(middle, s0, a, t1, b)});
            const bool is_double = std::strcmp(isa.name, oracle_fns().name) == 0;
            EXPECT_NEAR(sum, part(isa, "ltc_quad", m, parallelogram_of(middle, a, b)), is_double ? 1e-6 : 2e-5) << isa.name << i;
        }
    }
}

TEST(light, small_quads_are_density_times_solid_angle)
{
    Chance chance;
    for (int i = 0; i < 50; ++i) {
        const Matrix m = chance.lobe(0.2, 0.3);
        const Vec at = chance.upper(), x = unit(cross({0.3, 0.9, 0.1}, at)), y = cross(at, x);
        const double q = run_row(oracle_fns(), "ltc_density", joined({columns(m), flat({at})}))[0];
        for (const double size : {1e-2, 1e-3, 1e-4}) {
            const std::vector<Vec> quad = parallelogram_of(at, scaled(x, size), scaled(y, size));
            EXPECT_NEAR(part(oracle_fns(), "ltc_quad", m, quad) / (4.0 * size * size), q, 40.0 * size * std::max(q, 1.0)) << i << size;
        }
    }
}

TEST(light, on_the_horizon_and_below_there_is_none)
{
    for (const IsaFns& isa : all_fns()) {
        // A panel in the surface's plane, around the shading point and beside it. Rounding moves its corners above and below.
        for (const double x : {0.0, 0.5, 3.0}) {
            EXPECT_EQ(
                part(isa, "ltc_quad", kCosine, {{x - 1.0, -1.0, 0.0}, {x + 1.0, -1.0, 0.0}, {x + 1.0, 1.0, 0.0}, {x - 1.0, 1.0, 0.0}}),
                0.0);
            for (int signs = 0; signs < 16; ++signs) {
                const auto z = [signs](int i) { return signs >> i & 1 ? 1e-7 : -1e-7; };
                const std::vector<Vec> panel = {{x - 1.0, -1.0, z(0)}, {x + 1.0, -1.0, z(1)}, {x + 1.0, 1.0, z(2)}, {x - 1.0, 1.0, z(3)}};
                if (x < 1.0 && signs > 0 && signs < 15)
                    continue; // through the shading point: rounding decides between all and nothing
                const double expected = x < 1.0 && signs == 15 ? 1.0 : 0.0; // full coverage if just above the point
                EXPECT_NEAR(part(isa, "ltc_quad", kCosine, panel), expected, 2e-6) << isa.name << x << " " << signs;
            }
        }
        EXPECT_EQ(part(isa, "ltc_quad", kCosine, {{1.0, 0.0, -0.2}, {0.0, 1.0, -0.3}, {-1.0, 0.0, -0.1}, {0.0, -1.0, -0.1}}), 0.0);
        EXPECT_NEAR(part(isa, "ltc_quad", kCosine, {{1e5, -1e5, 1.0}, {1e5, 1e5, 1.0}, {-1e5, 1e5, 1.0}, {-1e5, -1e5, 1.0}}), 1.0, 1e-5);
        // A wall on the floor around the corner of a room: half of it is visible.
        EXPECT_NEAR(part(isa, "ltc_quad", kCosine, {{1.0, -1e4, -5.0}, {1.0, 1e4, -5.0}, {1.0, 1e4, 1e4}, {1.0, -1e4, 1e4}}), 0.5, 1e-3);
    }
}

TEST(light, corners_on_the_horizon_cut_once)
{
    const std::vector<Vec> diamond = {{1.0, 0.0, 1.0}, {1.0, 1.0, 0.0}, {1.0, 0.0, -1.0}, {1.0, -1.0, 0.0}};
    for (std::size_t first = 0; first < 4; ++first) {
        std::vector<Vec> corners = diamond;
        std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
        const std::vector<Vec> other_way(corners.rbegin(), corners.rend());
        for (const IsaFns& isa : all_fns()) {
            EXPECT_NEAR(part(isa, "ltc_quad", kCosine, corners), polygon_part(kCosine, diamond), 1e-6) << isa.name << first;
            EXPECT_NEAR(part(isa, "ltc_quad", kCosine, other_way), polygon_part(kCosine, diamond), 1e-6) << isa.name << first;
        }
    }
}

TEST(light, one_side_is_dark_from_behind)
{
    for (const IsaFns& isa : all_fns()) {
        EXPECT_EQ(run_row(isa, "ltc_sided", {0.25, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0}), (Row{0.25, 0.25}));
        EXPECT_EQ(run_row(isa, "ltc_sided", {0.25, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0}), (Row{0.0, 0.25}));
        EXPECT_EQ(run_row(isa, "ltc_sided", {0.25, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}), (Row{0.0, 0.25})); // within its plane
    }
}

TEST(light, clipless_is_near_and_the_same_above_the_horizon)
{
    Chance chance;
    std::vector<Row> rows;
    for (int i = 0; i < 4000; ++i)
        rows.push_back(any_quad(chance, 0.1, 0.2));
    const std::vector<Row> exact = run_rows(oracle_fns(), "ltc_quad", rows);
    for (const IsaFns& isa : all_fns()) {
        const std::vector<Row> got = run_rows(isa, "ltc_clipless", rows);
        double sum = 0.0, worst = 0.0;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            sum += std::abs(got[i][0] - exact[i][0]), worst = std::max(worst, std::abs(got[i][0] - exact[i][0]));
        }
        EXPECT_LT(sum / static_cast<double>(rows.size()), 0.006) << isa.name;
        EXPECT_LT(worst, 0.1) << isa.name;
        const std::vector<Vec> above = {{0.1, 0.2, 1.0}, {0.4, 0.2, 1.0}, {0.4, 0.5, 1.0}, {0.1, 0.5, 1.0}};
        EXPECT_NEAR(part(isa, "ltc_clipless", kCosine, above), part(isa, "ltc_quad", kCosine, above), 1e-6) << isa.name;
        const std::vector<Vec> other_way(above.rbegin(), above.rend());
        EXPECT_NEAR(part(isa, "ltc_clipless", kCosine, other_way), part(isa, "ltc_quad", kCosine, above), 1e-6) << isa.name;
    }
}

// Hard polygons: through the horizon, at the shading point, edge-on, antipodal corners, degenerate, behind, around.
constexpr const char* kHard[] = {"horizon", "touching", "edge_on", "antipodal", "degenerate", "behind", "around"};
constexpr int kKinds = static_cast<int>(std::size(kHard));

// Returns the 21 arguments of ltc_quad.
std::array<double, 21> hard_quad(Chance& chance, int kind, const std::vector<Row>& lobes)
{
    const double size = std::pow(10.0, chance.from(-4.0, 4.0)), far = 1e3 * size;
    const Vec middle = chance.point(size), a = chance.point(size), b = chance.point(size), here = {0.0, 0.0, 0.0};
    std::vector<Vec> quad;
    const int which = static_cast<int>(chance.from(0.0, 4.0));
    if (kind == 0)
        quad = parallelogram_of({middle.x, middle.y, 0.0}, a, b);
    else if (kind == 1) // a corner, on a side, or inside
        quad = parallelogram_of(along(here, std::floor(chance.from(-1.0, 2.0)), a, std::floor(chance.from(-1.0, 2.0)), b), a, b);
    else if (kind == 2)
        quad = parallelogram_of(along(here, chance.from(-3.0, 3.0), a, chance.from(-3.0, 3.0), b), a, b);
    else if (kind == 3)
        quad = {a, b, scaled(a, -1.0), scaled(b, -chance.from(0.5, 2.0))};
    else if (kind == 4 && which < 2)
        quad = which ? std::vector<Vec>{a, a, b, b} : std::vector<Vec>{a, a, a, a};
    else if (kind == 4)
        quad = which == 2 ? parallelogram_of(middle, a, scaled(a, 0.5)) : parallelogram_of(middle, scaled(a, 1e-18), scaled(b, 1e-18));
    else if (kind == 5)
        quad = parallelogram_of({middle.x, middle.y, -3.0 * size}, a, b);
    else
        quad = parallelogram_of({0.0, 0.0, std::pow(10.0, chance.from(-9.0, 0.0)) * size}, {far, 0.0, 0.0}, {0.0, far, 0.0});
    std::array<double, 21> arguments;
    const Row& m = lobes[chance.bits() % lobes.size()];
    std::copy(m.begin(), m.end(), arguments.begin());
    for (std::size_t i = 0; i < 4; ++i)
        arguments[9 + 3 * i] = quad[i].x, arguments[10 + 3 * i] = quad[i].y, arguments[11 + 3 * i] = quad[i].z;
    return arguments;
}

// Returns narrow lobes, and the plain cosine as every eighth.
std::vector<Row> hard_lobes(Chance& chance)
{
    std::vector<Row> lobes;
    for (int i = 0; i < 2000; ++i)
        lobes.push_back(columns(i % 8 ? chance.lobe(0.01, 0.02) : kCosine));
    return lobes;
}

// Each kind of light reads the arguments that it needs, in order.
void expect_no_nan(std::size_t count)
{
    constexpr std::size_t kChunk = 20000;
    Chance chance;
    const std::vector<Row> lobes = hard_lobes(chance);
    for (int kind = 0; kind < kKinds; ++kind) {
        std::size_t wrong = 0;
        for (std::size_t done = 0; done < count; done += kChunk) {
            std::vector<double> in(21 * kChunk);
            for (std::size_t k = 0; k < kChunk; ++k) {
                const std::array<double, 21> arguments = hard_quad(chance, kind, lobes);
                for (std::size_t i = 0; i < arguments.size(); ++i)
                    in[i * kChunk + k] = arguments[i];
            }
            for (const char* name : {"ltc_quad", "ltc_clipless", "ltc_disk", "ltc_sphere", "ltc_line"}) {
                const auto inputs = static_cast<std::ptrdiff_t>(test::kernel(fast_fns(), name).inputs);
                const std::vector<double> out =
                    test::call(fast_fns(), name, {in.begin(), in.begin() + inputs * static_cast<std::ptrdiff_t>(kChunk)});
                for (std::size_t k = 0; k < kChunk; ++k) {
                    const double flow = out[kChunk + k] + out[2 * kChunk + k] + out[3 * kChunk + k];
                    if (!(out[k] >= 0.0 && out[k] <= 1.0 && std::isfinite(flow)) && wrong++ < 3)
                        ADD_FAILURE() << kHard[kind] << " " << name << " " << out[k] << " " << flow;
                }
            }
        }
        EXPECT_EQ(wrong, 0u) << kHard[kind];
    }
}

TEST(light, hard_ones_are_numbers)
{
    expect_no_nan(100000);
}

TEST(light, hard_ones_are_numbers_in_ten_million)
{
    expect_no_nan(10000000);
}

TEST(light, every_instruction_set_has_the_same_bits)
{
    Chance chance;
    const std::vector<Row> lobes = hard_lobes(chance);
    std::vector<Row> quads, looked, seen;
    for (int i = 0; i < 3000; ++i) {
        const std::array<double, 21> hard = hard_quad(chance, i / 2 % kKinds, lobes);
        const Row quad = i % 2 ? any_quad(chance, 0.01, 0.02) : Row(hard.begin(), hard.end());
        quads.push_back(quad);
        const Vec eye = chance.point(1.0);
        looked.push_back({eye.x, eye.y, eye.z, chance.from(-0.1, 1.2), chance.from(-0.1, 1.2)});
        seen.push_back(joined({looked.back(), Row(quad.begin() + 9, quad.end())}));
    }
    const auto of = [&quads](std::size_t numbers) {
        std::vector<Row> rows;
        for (const Row& quad : quads)
            rows.push_back(Row(quad.begin(), quad.begin() + static_cast<std::ptrdiff_t>(numbers)));
        return rows;
    };
    const std::vector<Row> eighteen = of(18), sixteen = of(16), thirteen = of(13), twelve = of(12);
    // Neighbours in one cell of the table, in two cells and in more, as in an image. The kernel reads their texels in different ways.
    std::vector<Row> shared;
    for (int i = 0; i < 3000; ++i) {
        const double theta = i % (1 + i / 750) == 0 ? 0.7 : 1.2, phi = i / 64 % 2 ? 0.5 : 2.1;
        const double t = theta + chance.from(0.0, 0.15), p = phi + chance.from(-0.02, 0.02);
        shared.push_back(
            {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t), chance.from(0.35, 0.5), chance.from(0.1, 0.12)});
    }
    std::vector<Row> textures;
    for (const Row& quad : quads)
        textures.push_back(joined({quad, {64.0, 32.0, 6.0}}));
    const IsaFns& scalar = float_fns()[0];
    ASSERT_GT(float_fns().size(), 1u);
    for (const auto& [name, rows] : {std::pair<const char*, const std::vector<Row>*>{"ltc_lookup", &looked},
                                     {"ltc_lookup", &shared},
                                     {"ltc_quad_seen", &seen},
                                     {"ltc_density", &twelve},
                                     {"ltc_triangle", &eighteen},
                                     {"ltc_quad", &quads},
                                     {"ltc_clipless", &quads},
                                     {"ltc_disk", &eighteen},
                                     {"ltc_sphere", &thirteen},
                                     {"ltc_line", &sixteen},
                                     {"ltc_texture", &textures}}) {
        const std::vector<Row> expected = run_rows(scalar, name, *rows, shipped_view());
        for (std::size_t k = 1; k < float_fns().size(); ++k) {
            const std::vector<Row> got = run_rows(float_fns()[k], name, *rows, shipped_view());
            int differ = 0;
            for (std::size_t i = 0; i < got.size(); ++i)
                for (std::size_t j = 0; j < got[i].size(); ++j)
                    differ += std::memcmp(&got[i][j], &expected[i][j], sizeof(double)) != 0;
            EXPECT_EQ(differ, 0) << name << " " << float_fns()[k].name;
        }
    }
}

} // namespace
} // namespace burnish::ltc
