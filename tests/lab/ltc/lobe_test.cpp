// Laws for the fitted lobe and for the density of the fit.
#include <gtest/gtest.h>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/interpolant_fit.h"
#include "shading/lab/ltc/node_fit.h"
#include "shading/lab/ltc/pair_fit.h"

namespace burnish::ltc {
namespace {

const Place kPlaces[] = {{0.0, 0.0, 0.5, 1.0}, {0.7, 0.4, 0.3, 0.4}, {1.3, 1.1, 0.8, 0.25}, {1.0, 0.0, 0.1, 0.1}, {0.5, 1.5, 1.0, 0.7}};

Vec direction(std::size_t k) // over the sphere
{
    const std::array<double, 4> u = spread_point(k);
    const double z = 2.0 * u[0] - 1.0, r = std::sqrt(1.0 - z * z);
    return {r * std::cos(2.0 * kPi * u[1]), r * std::sin(2.0 * kPi * u[1]), z};
}

TEST(lobe, densities_integrate_to_one)
{
    const Rule rule(22), points(20);
    for (const Place& place : kPlaces) {
        const Lobe lobe = normalised_lobe(place, rule);
        const Matrix m = with_unit_axis(natural_matrix(place));
        const Matrix n = inverse(m);
        // Integrates all three densities by points drawn from two of them, so that no density confirms itself.
        double visible = 0.0, reflected = 0.0, cosine = 0.0;
        for (const Rule::Point& point : points.points) {
            const Vec a = mirrored_normal(lobe, point), b = unit(m * point.clamped);
            for (const Vec& l : {a, b}) {
                const Reflected f = density(lobe, l);
                const double q = transformed_cosine(n, l), both = f.visible + q;
                visible += f.visible / both, reflected += f.reflected / both, cosine += q / both;
            }
        }
        const double count = static_cast<double>(points.points.size());
        EXPECT_NEAR(visible / count, 1.0, 4e-3) << place.theta;
        EXPECT_NEAR(reflected / count, 1.0, 4e-3) << place.theta;
        EXPECT_NEAR(cosine / count, 1.0, 4e-3) << place.theta;
    }
}

TEST(lobe, mirrored_normals_have_their_density)
{
    // The mean of 1 / density over a set of directions is the set's solid angle: an octant ahead.
    const Rule rule(22);
    const Lobe lobe(kPlaces[1]);
    double inside = 0.0, expected = 0.0;
    for (const Rule::Point& point : rule.points) {
        const Vec l = mirrored_normal(lobe, point);
        inside += l.x < -0.3 && l.z > 0.5 ? 1.0 : 0.0;
    }
    constexpr std::size_t kDirections = 400000;
    for (std::size_t k = 0; k < kDirections; ++k)
        if (const Vec l = direction(k); l.x < -0.3 && l.z > 0.5)
            expected += density(lobe, l).visible * 4.0 * kPi / kDirections;
    EXPECT_NEAR(inside / static_cast<double>(rule.points.size()), expected, 2e-3);
}

TEST(lobe, gauges_are_one_density)
{
    for (const Place& place : kPlaces) {
        const Matrix m = natural_matrix(place), aligned = in_natural_gauge(m, place);
        for (const double turn : {0.3, 1.9, -2.5})
            for (const double flip : {1.0, -1.0}) {
                const double c = std::cos(turn), s = std::sin(turn);
                const Matrix other = m * Matrix{c, -s * flip, 0.0, s, c * flip, 0.0, 0.0, 0.0, 1.0};
                const Matrix back = in_natural_gauge(other, place);
                EXPECT_GT(determinant(back), 0.0);
                for (std::size_t e = 0; e < 9; ++e)
                    EXPECT_NEAR(back[e], aligned[e], 1e-12) << "element " << e << " of a matrix that was turned by " << turn;
                for (std::size_t k = 0; k < 200; ++k) {
                    const double q = transformed_cosine(inverse(m), direction(k));
                    EXPECT_NEAR(transformed_cosine(inverse(other), direction(k)), q, 1e-12 * std::max(q, 1.0));
                }
            }
    }
}

TEST(lobe, unaligned_neighbours_interpolate_to_another_lobe)
{
    // Shows why the gauge is needed: two matrices for one lobe, one turned, have a wrong mean.
    const Place place = kPlaces[1];
    const Rule rule(15), white(18);
    const LobePoints points(normalised_lobe(place, white), rule);
    const Matrix m = fit_lobe(points, natural_matrix(place), 0).m;
    const double c = std::cos(2.0), s = std::sin(2.0);
    const Matrix turned = m * Matrix{c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
    const auto middle = [](const Matrix& a, const Matrix& b) {
        Matrix r;
        for (std::size_t e = 0; e < 9; ++e)
            r[e] = 0.5 * (a[e] + b[e]);
        return r;
    };
    const double alone = l1_distance(points, m);
    EXPECT_NEAR(l1_distance(points, turned), alone, 0.01); // with other points
    EXPECT_GT(l1_distance(points, middle(m, turned)), alone + 0.1);
    EXPECT_NEAR(l1_distance(points, middle(in_natural_gauge(m, place), in_natural_gauge(turned, place))), alone, 0.01);
}

TEST(lobe, of_other_models_integrate_to_one_and_are_near_what_is_fitted_to_them)
{
    const Rule rule(15), white(20), fine(22);
    for (const Model model : {Model::beckmann, Model::ashikhmin_shirley, Model::ward})
        for (const Place& place : {Place{0.0, 0.0, 0.3, 1.0}, Place{0.7, 0.4, 0.3, 0.4}, Place{1.2, 1.1, 0.2, 0.5}}) {
            const Lobe lobe = normalised_lobe(place, white, model);
            double whole = 0.0; // over all directions, independent of the points' density
            for (std::size_t k = 0; k < 400000; ++k)
                whole += density(lobe, direction(k)).reflected * 4.0 * kPi / 400000.0;
            EXPECT_NEAR(whole, 1.0, 0.01) << static_cast<int>(model) << " " << place.theta;
            const LobePoints points(lobe, rule);
            const NodeFit fit = fit_lobe(points, natural_matrix(place), 0);
            EXPECT_LT(fit.l1, l1_distance(points, with_unit_axis(natural_matrix(place)))) << static_cast<int>(model);
            EXPECT_LT(fit.l1, 0.45) << static_cast<int>(model) << " " << place.theta;
        }
}

TEST(lobe, a_sum_of_two_is_nearer_where_one_is_far_off)
{
    const Rule rule(15), white(18), others(17);
    for (const Place& place : {Place{0.94, 0.49, 0.5, 0.14}, Place{1.13, 1.34, 0.35, 0.14}}) {
        const Lobe lobe = normalised_lobe(place, white);
        const LobePoints points(lobe, rule);
        const NodeFit one = fit_lobe(points, natural_matrix(place), 0);
        const PairFit two = fit_pair(points, one.m);
        EXPECT_GT(one.l1, 0.3);
        EXPECT_LT(two.l1, 0.7 * one.l1);
        EXPECT_NEAR(l1_of_pair(LobePoints(lobe, others), two), two.l1, 0.01); // by points outside the fit
        EXPECT_GT(determinant(two.m[0]), 0.0);
        EXPECT_GT(determinant(two.m[1]), 0.0);
        const PairFit same = {{one.m, one.m}, 0.3, 0.0, 0}; // two equal lobes
        EXPECT_NEAR(l1_of_pair(points, same), one.l1, 1e-9);
    }
}

TEST(lobe, small_widths_need_no_fit)
{
    const Rule rule(15), white(18);
    const Place place = {0.6, 0.5, 0.001, 0.5};
    EXPECT_LT(l1_distance(LobePoints(normalised_lobe(place, white), rule), natural_matrix(place)), 0.002);
}

} // namespace
} // namespace burnish::ltc
