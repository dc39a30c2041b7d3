// Discs, spheres, lines and textured quads at run time.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/polygon.h"
#include "tests/unit/adversary/lit.h"

namespace burnish::ltc {
namespace {

using test::all_fns;
using test::IsaFns;
using test::oracle_fns;

Row of_disk(const IsaFns& isa, const Matrix& m, const Vec& middle, const Vec& a, const Vec& b)
{
    return run_row(isa, "ltc_disk", joined({columns(m), flat({middle, a, b})}));
}

Row of_sphere(const IsaFns& isa, const Matrix& m, const Vec& middle, double radius)
{
    return run_row(isa, "ltc_sphere", joined({columns(m), flat({middle}), {radius}}));
}

struct Axes {
    Vec w, s, t; // w towards a direction
};
Axes axes_about(const Vec& w)
{
    const Vec s = unit(cross({0.31, 0.9, 0.17}, w));
    return {w, s, cross(w, s)};
}

// Evaluates an ellipse as a polygon of many corners, by the fit's sum.
double many_corners(const Matrix& m, const Vec& middle, const Vec& a, const Vec& b)
{
    std::vector<Vec> corners;
    for (int k = 0; k < 2000; ++k)
        corners.push_back(along(middle, std::cos(k * kPi / 1000.0), a, std::sin(k * kPi / 1000.0), b));
    return polygon_part(inverse(m), corners);
}

TEST(round, discs_above_the_horizon_are_polygons_of_many_corners)
{
    Chance chance;
    int above = 0;
    double off = 0.0;
    for (int i = 0; i < 400; ++i) {
        const Matrix m = i % 4 ? chance.lobe(0.05, 0.1) : kCosine;
        const double size = std::pow(10.0, chance.from(-2.0, 0.7));
        const Axes axes = axes_about(chance.upper());
        const Vec middle = chance.upper(), a = scaled(axes.s, size), b = scaled(axes.t, size * chance.from(0.2, 1.0));
        const Matrix n = inverse(m);
        bool up = true, down = true;
        for (int k = 0; k < 64; ++k) {
            const double z = (n * along(middle, std::cos(k * kPi / 32.0), a, std::sin(k * kPi / 32.0), b)).z;
            up = up && z > 0.0, down = down && z < 0.0;
        }
        const double expected = many_corners(m, middle, a, b);
        for (const IsaFns& isa : all_fns()) {
            const Row got = of_disk(isa, m, middle, a, b);
            if (up) {
                EXPECT_NEAR(got[3], expected, 2e-5) << isa.name << i; // the form factor; the sphere's horizon differs from the ellipse's
            }
            if (down) {
                EXPECT_NEAR(got[0], 0.0, 0.01) << isa.name << i;
            }
            EXPECT_NEAR(got[0], expected, 0.12) << isa.name << i;
        }
        above += up;
        off += std::abs(of_disk(oracle_fns(), m, middle, a, b)[0] - expected) / 400.0;
    }
    EXPECT_GT(above, 100);
    EXPECT_LT(off, 0.006);
}

TEST(round, small_discs_are_density_times_solid_angle)
{
    Chance chance;
    for (int i = 0; i < 50; ++i) {
        const Matrix m = chance.lobe(0.2, 0.3);
        const Axes axes = axes_about(chance.upper());
        const double q = run_row(oracle_fns(), "ltc_density", joined({columns(m), flat({axes.w})}))[0];
        for (const double r : {1e-2, 1e-3, 1e-4})
            EXPECT_NEAR(of_disk(oracle_fns(), m, axes.w, scaled(axes.s, r), scaled(axes.t, r))[0] / (kPi * r * r), q,
                        40.0 * r * std::max(q, 1.0))
                << i << r;
    }
}

TEST(round, spheres_under_a_cosine_are_exact)
{
    // Fully visible: the radius' sine squared times the elevation's cosine. Half sunk: by a sum over directions.
    for (const IsaFns& isa : all_fns())
        for (const double r : {0.05, 0.3, 0.6}) {
            EXPECT_NEAR(of_sphere(isa, kCosine, {0.6, 0.0, 0.8}, r)[0], r * r * 0.8, 2e-6) << isa.name << r;
            EXPECT_EQ(of_sphere(isa, kCosine, {0.3, 0.2, -0.99}, r)[0], 0.0);
            for (const double z : {-0.6 * r, 0.0, 0.5 * r}) {
                const Vec w = {std::sqrt(1.0 - z * z), 0.0, z};
                const Axes axes = axes_about(w);
                const double least = std::sqrt(1.0 - r * r);
                constexpr int kSteps = 600;
                double sum = 0.0;
                for (int i = 0; i < kSteps; ++i)
                    for (int k = 0; k < kSteps; ++k) {
                        const double c = 1.0 - (1.0 - least) * (i + 0.5) / kSteps, s = std::sqrt(1.0 - c * c),
                                     turn = 2.0 * kPi * (k + 0.5) / kSteps;
                        sum += std::max(0.0, along(scaled(w, c), s * std::cos(turn), axes.s, s * std::sin(turn), axes.t).z);
                    }
                sum *= 2.0 * (1.0 - least) / (static_cast<double>(kSteps) * kSteps);
                EXPECT_NEAR(of_sphere(isa, kCosine, w, r)[0], sum, 2e-5) << isa.name << r << " " << z;
            }
        }
}

TEST(round, spheres_are_the_discs_of_their_outline_and_all_from_within)
{
    Chance chance;
    for (int i = 0; i < 60; ++i) {
        const Matrix m = chance.lobe(0.05, 0.1);
        const Vec middle = scaled(chance.upper(), chance.from(1.0, 3.0));
        const double d2 = dot(middle, middle), r = chance.from(0.1, 0.9), kept = 1.0 - r * r / d2;
        const Axes axes = axes_about(unit(middle));
        for (const IsaFns& isa : all_fns()) {
            const double disk =
                of_disk(isa, m, scaled(middle, kept), scaled(axes.s, r * std::sqrt(kept)), scaled(axes.t, r * std::sqrt(kept)))[0];
            EXPECT_NEAR(of_sphere(isa, m, middle, r)[0], disk, 2e-5) << isa.name << i;
            EXPECT_EQ(of_sphere(isa, m, middle, std::sqrt(d2) * 1.001)[0], 1.0) << isa.name;
            EXPECT_EQ(of_sphere(isa, m, {0.0, 0.0, 0.0}, r)[0], 1.0) << isa.name;
            // Almost touching: half of all directions.
            const double half = of_sphere(isa, m, middle, std::sqrt(d2) * 0.99999)[0];
            EXPECT_NEAR(half, many_corners(m, axes.w, scaled(axes.s, 200.0), scaled(axes.t, 200.0)), 0.12) << isa.name;
        }
    }
}

TEST(round, lines_are_thin_quads)
{
    Chance chance;
    double most = 0.0;
    for (int i = 0; i < 300; ++i) {
        const Matrix m = i % 4 ? chance.lobe(0.1, 0.2) : kCosine;
        const Vec p = chance.point(1.0), q = chance.point(1.0), o = unit(cross(p, q));
        const double thin = 1e-5;
        const double quad = polygon_part(inverse(m), {along(p, -thin, o, 0.0, o), along(q, -thin, o, 0.0, o), along(q, thin, o, 0.0, o),
                                                      along(p, thin, o, 0.0, o)}) /
                            thin;
        most = std::max(most, quad);
        for (const IsaFns& isa : all_fns())
            EXPECT_NEAR(run_row(isa, "ltc_line", joined({columns(m), flat({p, q}), {thin}}))[0] / thin, quad, 1e-3 * std::max(quad, 1.0))
                << isa.name << i;
    }
    EXPECT_GT(most, 0.5);
}

TEST(round, lines_that_point_here_or_lie_below_are_dark)
{
    for (const IsaFns& isa : all_fns()) {
        const auto part = [&isa](const Vec& p, const Vec& q) {
            return run_row(isa, "ltc_line", joined({columns(kCosine), flat({p, q}), {0.01}}))[0];
        };
        EXPECT_EQ(part({0.0, 0.0, 1.0}, {0.0, 0.0, 3.0}), 0.0);
        EXPECT_EQ(part({1.0, 0.0, -0.1}, {0.0, 1.0, -0.5}), 0.0);
        EXPECT_EQ(part({1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), 0.0);
        EXPECT_EQ(part({0.2, 0.0, 1.0}, {0.2, 0.0, 1.0}), 0.0);
    }
}

TEST(round, textures_are_met_where_their_light_comes_from)
{
    Chance chance;
    for (int i = 0; i < 200; ++i) {
        const Matrix m = chance.lobe(0.05, 0.2);
        const Axes axes = axes_about(chance.upper());
        const Vec corner = along(axes.w, -0.4, axes.s, -0.3, axes.t), u = scaled(axes.s, 0.9), v = scaled(axes.t, 0.8);
        const double s = chance.from(0.05, 0.95), t = chance.from(0.05, 0.95);
        const Vec flow = scaled(inverse(m) * along(corner, s, u, t, v), 1e-9); // towards a known place, from a small light
        for (const IsaFns& isa : all_fns()) {
            const Row got = run_row(isa, "ltc_texture", joined({columns(m), flat({flow, corner, u, v}), {256.0, 128.0, 8.0}}));
            EXPECT_NEAR(got[0], s, 2e-4) << isa.name << i;
            EXPECT_NEAR(got[1], t, 2e-4) << isa.name << i;
            for (const double sign : {-1.0, 1.0}) // the row ends on the texture
                for (int k = 0; k < 2; ++k) {
                    const double end = got[static_cast<std::size_t>(k)] + sign * got[static_cast<std::size_t>(k) + 2];
                    EXPECT_TRUE(end > -1e-4 && end < 1.0001) << isa.name << i << " " << end;
                }
        }
    }
}

// A cap 30 degrees from the normal, of radius 40 degrees. A sum over the cap gives the mean direction of a cosine's light.
TEST(round, textures_are_met_where_a_cosine_has_its_light)
{
    const Vec f = {std::sin(kPi / 6.0), 0.0, std::cos(kPi / 6.0)};
    const double radius = 40.0 * kPi / 180.0;
    const Axes axes = axes_about(f);
    Vec sum = {0.0, 0.0, 0.0};
    for (int i = 0; i < 400; ++i)
        for (int k = 0; k < 400; ++k) {
            const double z = 1.0 - (1.0 - std::cos(radius)) * (i + 0.5) / 400.0, side = std::sqrt(1.0 - z * z),
                         turn = 2.0 * kPi * k / 400.0;
            const Vec w = along(scaled(f, z), side * std::cos(turn), axes.s, side * std::sin(turn), axes.t);
            sum = along(sum, w.z, w, 0.0, w);
        }
    const Vec flow = scaled(f, std::sin(radius) * std::sin(radius));
    for (const IsaFns& isa : all_fns()) { // on a plane at height 1, with sides from -5 to 5
        const Row got =
            run_row(isa, "ltc_texture",
                    joined({columns(kCosine), flat({flow, {-5.0, -5.0, 1.0}, {10.0, 0.0, 0.0}, {0.0, 10.0, 0.0}}), {256.0, 256.0, 8.0}}));
        EXPECT_NEAR(got[0], 0.5 + 0.1 * sum.x / sum.z, 1e-4) << isa.name;
        EXPECT_NEAR(got[1], 0.5, 1e-4) << isa.name;
    }
}

// Squares of side 2. A plain cosine at height 2 h blurs evenly, 0.6 times as wide as its height. A cosine stretched four times along x
// needs a row along the texture's u. The row has the variance that the even blur does not cover.
TEST(round, textures_are_blurred_as_the_lobe_is_wide)
{
    Matrix wide = kCosine;
    wide[0] = 4.0;
    for (const IsaFns& isa : all_fns())
        for (const double h : {0.004, 0.01, 0.03}) {
            const Row square = flat({{0.0, 0.0, 1.0}, {-1.0, -1.0, 2.0 * h}, {2.0, 0.0, 0.0}, {0.0, 2.0, 0.0}});
            const double narrow = 0.6 * h * 256.0; // texels
            const Row even = run_row(isa, "ltc_texture", joined({columns(kCosine), square, {256.0, 256.0, 8.0}}));
            EXPECT_NEAR(even[4], std::max(0.0, std::log2(narrow / 0.8)), 1e-3) << isa.name << h;
            EXPECT_NEAR(std::hypot(even[2], even[3]), 0.0, 1e-4) << isa.name << h;
            const Row row = run_row(isa, "ltc_texture", joined({columns(wide), square, {256.0, 256.0, 8.0}}));
            EXPECT_NEAR(row[2] * row[2] * 256.0 * 256.0 / 3.0, 15.0 * narrow * narrow, 0.01 * narrow * narrow) << isa.name << h;
            EXPECT_NEAR(row[3], 0.0, 1e-5) << isa.name << h;
            Row lost = joined({columns(kCosine), square, {256.0, 256.0, 8.0}});
            lost[9] = lost[10] = lost[11] = 0.0; // no flow
            EXPECT_EQ(run_row(isa, "ltc_texture", lost), (Row{0.5, 0.5, 0.0, 0.0, 8.0})) << isa.name;
        }
}

} // namespace
} // namespace burnish::ltc
