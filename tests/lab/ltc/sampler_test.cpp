// Sampling of transformed cosines, and checks by samples alone, without formulas from the fit or the kernels.
#include <gtest/gtest.h>

#include <array>

#include "core/math/scalar_math.h"
#include "shading/lab/ltc/node_fit.h"
#include "tests/unit/adversary/lit.h"

namespace burnish::ltc {
namespace {

Vec cosine_point(Chance& chance) // with the density z / pi
{
    const double r = std::sqrt(chance.from(0.0, 1.0)), turn = chance.from(0.0, 2.0 * kPi);
    return {r * std::cos(turn), r * std::sin(turn), std::sqrt(std::max(0.0, 1.0 - r * r))};
}

// Evaluates the density kernel, one direction a row.
std::vector<double> densities(const Matrix& m, const std::vector<Vec>& directions)
{
    std::vector<Row> rows;
    for (const Vec& l : directions)
        rows.push_back(joined({columns(m), flat({l})}));
    std::vector<double> q;
    for (const Row& row : run_rows(test::oracle_fns(), "ltc_density", rows))
        q.push_back(row[0]);
    return q;
}

// Uses bins of equal solid angle over the sphere. Sums the density's mass in each bin over midpoints of smaller bins.
TEST(sampler, images_of_cosine_points_have_the_density)
{
    constexpr int kRows = 16, kColumns = 32, kFine = 16, kSamples = 200000;
    Chance chance;
    for (const Place& place : {Place{0.4, 0.6, 0.8, 0.7}, Place{0.9, 1.1, 0.5, 0.4}, Place{1.2, 0.3, 0.6, 0.3}}) {
        const Matrix m = lookup(halves(), place).m;
        std::vector<double> expected(kRows * kColumns, 0.0), found(kRows * kColumns, 0.0);
        std::vector<Vec> middles;
        for (int row = 0; row < kRows * kFine; ++row)
            for (int column = 0; column < kColumns * kFine; ++column) {
                const double z = 2.0 * (row + 0.5) / (kRows * kFine) - 1.0, turn = 2.0 * kPi * (column + 0.5) / (kColumns * kFine);
                const double r = std::sqrt(1.0 - z * z);
                middles.push_back({r * std::cos(turn), r * std::sin(turn), z});
            }
        const std::vector<double> q = densities(m, middles);
        for (std::size_t i = 0; i < q.size(); ++i) {
            const std::size_t row = i / (kColumns * kFine) / kFine, column = i % (kColumns * kFine) / kFine;
            expected[row * kColumns + column] += q[i] * 4.0 * kPi / static_cast<double>(q.size()) * kSamples;
        }
        for (int k = 0; k < kSamples; ++k) {
            const Vec w = unit(m * cosine_point(chance));
            const double turn = std::atan2(w.y, w.x) / (2.0 * kPi);
            const int row = std::min(kRows - 1, static_cast<int>((w.z + 1.0) * 0.5 * kRows)),
                      column = std::min(kColumns - 1, static_cast<int>((turn < 0.0 ? turn + 1.0 : turn) * kColumns));
            found[static_cast<std::size_t>(row * kColumns + column)] += 1.0;
        }
        double chi2 = 0.0, few_expected = 0.0, few_found = 0.0;
        int bins = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            if (expected[i] < 20.0) {
                few_expected += expected[i], few_found += found[i];
            } else {
                chi2 += (found[i] - expected[i]) * (found[i] - expected[i]) / expected[i], ++bins;
            }
        if (few_expected >= 5.0)
            chi2 += (few_found - few_expected) * (few_found - few_expected) / few_expected, ++bins;
        const double freedom = bins - 1; // the quantile of 1 - 1e-5 by Wilson and Hilferty
        const double root = 1.0 - 2.0 / (9.0 * freedom) + 4.26 * std::sqrt(2.0 / (9.0 * freedom));
        EXPECT_LT(chi2, freedom * root * root * root) << place.theta << ", bins " << bins;
        EXPECT_GT(bins, 60);
    }
}

// Compares a quad with points on its area under the transformed cosine. The fit's error cancels, so chance alone remains.
TEST(sampler, quads_are_the_mean_over_their_points)
{
    constexpr int kSamples = 40000;
    Chance chance;
    int quads = 0;
    for (int i = 0; i < 60; ++i) {
        const Place place = {chance.from(0.0, 1.4), chance.from(0.0, 1.57), chance.from(0.2, 1.5), chance.from(0.15, 1.0)};
        const Matrix m = lookup(halves(), place).m;
        const Vec middle = chance.point(1.5), a = chance.point(0.8), b = chance.point(0.8), normal = cross(a, b);
        std::vector<Vec> at;
        for (int k = 0; k < kSamples; ++k)
            at.push_back(along(along(middle, chance.from(-1.0, 1.0), a, 0.0, a), chance.from(-1.0, 1.0), b, 0.0, b));
        std::vector<Vec> directions;
        for (const Vec& p : at)
            directions.push_back(unit(p));
        const std::vector<double> q = densities(m, directions);
        double sum = 0.0, squares = 0.0;
        for (std::size_t k = 0; k < at.size(); ++k) { // over solid angle: area 4 |n|, cosine |n.l| / |n|
            const double value = q[k] * 4.0 * std::abs(dot(normal, directions[k])) / dot(at[k], at[k]);
            sum += value, squares += value * value;
        }
        const double mean = sum / kSamples, sigma = std::sqrt(std::max(squares / kSamples - mean * mean, 0.0) / kSamples);
        const auto corner = [&](double s, double t) { return along(middle, s, a, t, b); };
        const Row quad = flat({corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)});
        const double part = run_row(test::oracle_fns(), "ltc_quad", joined({columns(m), quad}))[0];
        if (!(mean > 1e-3) || sigma > 0.1 * mean) // nothing to compare, or too near to sample
            continue;
        ++quads;
        EXPECT_NEAR(part, mean, 4.0 * sigma + 1e-6) << i;
    }
    EXPECT_GT(quads, 30);
}

// KT et al. 2022 advise against sampling the cosine: its density is far below a lune-shaped lobe's.
TEST(sampler, visible_normals_have_less_variance)
{
    constexpr int kSamples = 40000;
    const Rule white(20);
    Chance chance;
    double worst_cosine = 0.0, worst_visible = 0.0;
    for (const Place& place : {Place{0.3, 0.4, 0.3, 0.8}, Place{0.9, 0.5, 0.5, 0.15}, Place{1.3, 1.0, 0.4, 0.4}}) {
        const Lobe lobe = normalised_lobe(place, white);
        const Matrix m = lookup(halves(), place).m, n = inverse(m);
        double cosine[2] = {}, visible[2] = {};
        for (int k = 0; k < kSamples; ++k) {
            const auto add = [](double* sums, double weight) { sums[0] += weight, sums[1] += weight * weight; };
            const Vec l = unit(m * cosine_point(chance));
            add(cosine, density(lobe, l).reflected / transformed_cosine(n, l));
            const double turn = chance.from(0.0, 2.0 * kPi);
            const Reflected f = density(lobe, mirrored_normal(lobe, {chance.from(0.0, 1.0), std::cos(turn), std::sin(turn), {}}));
            add(visible, f.visible > 0.0 ? f.reflected / f.visible : 0.0);
        }
        const auto variance = [](const double* sums) { return sums[1] / kSamples - sums[0] * sums[0] / (kSamples * kSamples); };
        printf("variance of a white furnace: cosines %.4f, visible normals %.4f\n", variance(cosine), variance(visible));
        EXPECT_NEAR(cosine[0] / kSamples, 1.0, 5.0 * std::sqrt(variance(cosine) / kSamples) + 1e-3);
        EXPECT_NEAR(visible[0] / kSamples, 1.0, 5.0 * std::sqrt(variance(visible) / kSamples) + 1e-3);
        worst_cosine = std::max(worst_cosine, variance(cosine)), worst_visible = std::max(worst_visible, variance(visible));
    }
    EXPECT_GT(worst_cosine, 2.0 * worst_visible);
}

TEST(sampler, other_models_are_what_shading_reflects_by)
{
    Chance chance;
    for (int i = 0; i < 2000; ++i) {
        const Place place = {chance.from(0.0, 1.5), chance.from(0.0, 1.57), chance.from(0.05, 1.0), chance.from(0.1, 1.0)};
        const Vec l = chance.upper();
        for (const Model model : {Model::beckmann, Model::ashikhmin_shirley, Model::ward}) {
            const Lobe lobe(place, 1.0, model);
            const Row row = run_row(test::oracle_fns(), "ltc_other_lobes", joined({flat({lobe.v, l}), {lobe.alpha_x, lobe.alpha_y}}));
            const double expected = row[static_cast<std::size_t>(model) - 1] * l.z;
            EXPECT_NEAR(density(lobe, l).reflected, expected, 1e-4 * expected + 1e-9) << static_cast<int>(model) << " " << i;
        }
    }
}

} // namespace
} // namespace burnish::ltc
