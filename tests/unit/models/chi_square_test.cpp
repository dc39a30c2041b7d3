// Samples of every model against its pdf: Pearson's chi-square over 16 x 16 bins and one bin for rejected samples. Seeds are fixed, and all
// runs together have one significance level (Sidak 1967). BN_LONG_RUNS: more samples and finer integrals.
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

#ifdef BN_LONG_RUNS
constexpr std::size_t kSamples = 4'000'000;
constexpr std::size_t kFineness = 4;
#else
constexpr std::size_t kSamples = 60'000;
constexpr std::size_t kFineness = 1;
#endif
constexpr std::size_t kBins = 16;                 // a side
constexpr std::size_t kCells = kBins * kBins + 1; // the last: rejected samples
constexpr double kSignificance = 0.01;

// Upper regularised incomplete gamma function Q(a, x): series for small x, else Lentz's continued fraction.
double gamma_q(double a, double x)
{
    const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int i = 1; i < 10000 && term > sum * 1e-14; ++i) {
            term *= x / (a + i);
            sum += term;
        }
        return 1 - scale * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, value = d;
    for (int i = 1; i < 10000; ++i) {
        const double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        value *= d * c;
        if (std::abs(d * c - 1) < 1e-14)
            break;
    }
    return scale * value;
}

// Returns the p-value of counts against expected numbers with an equal sum. Pools cells expected below 5.
double p_value(const std::vector<double>& observed, const std::vector<double>& expected)
{
    double statistic = 0, pooled_o = 0, pooled_e = 0;
    int cells = 0;
    for (std::size_t c = 0; c < observed.size(); ++c) {
        if (expected[c] < 5) {
            pooled_o += observed[c];
            pooled_e += expected[c];
            continue;
        }
        statistic += (observed[c] - expected[c]) * (observed[c] - expected[c]) / expected[c];
        ++cells;
    }
    if (pooled_e >= 5) {
        statistic += (pooled_o - pooled_e) * (pooled_o - pooled_e) / pooled_e;
        ++cells;
    }
    return cells < 2 ? 1 : gamma_q(0.5 * (cells - 1), 0.5 * statistic);
}

std::size_t cell_of(const Chart& chart, Vec wi)
{
    const std::array<double, 2> at = chart.of(wi);
    const auto bin = [](double x) { return std::min(static_cast<std::size_t>(std::max(x, 0.0) * kBins), kBins - 1); };
    return bin(at[0]) * kBins + bin(at[1]);
}

std::vector<double> counted(const ModelCase& model, const std::vector<double>& params, const Chart& chart, std::uint64_t seed)
{
    std::vector<double> cells(kCells);
    Random random(seed);
    constexpr std::size_t kAtOnce = 20'000;
    for (std::size_t done = 0; done < kSamples; done += kAtOnce) {
        Batch batch(params, kAtOnce);
        for (std::size_t k = 0; k < kAtOnce; ++k) {
            const double x = random.next(), y = random.next(), z = random.next();
            batch.set(k, chart.wo, {x, y, z});
        }
        const std::vector<double> s = batch.run(fns_of(fast_fns(), model).sample);
        for (std::size_t k = 0; k < kAtOnce; ++k) {
            const bool valid = s[6 * kAtOnce + k] != 0;
            cells[valid ? cell_of(chart, {s[k], s[kAtOnce + k], s[2 * kAtOnce + k]}) : kCells - 1] += 1;
        }
    }
    return cells;
}

// Integrates the pdf over the cells by the midpoint rule. The rejected cell gets the rest.
std::vector<double> foretold(const ModelCase& model, const std::vector<double>& params, const Chart& chart)
{
    // Points per bin side. Refraction is narrow at grazing views, and its chart does not follow it.
    const std::size_t points = kFineness * (chart.half ? 12 : 32);
    const std::size_t side = kBins * points, count = side * points;
    std::vector<double> cells(kCells);
    for (std::size_t row = 0; row < kBins; ++row) { // one row of cells at a time
        Batch batch(params, count);
        std::vector<double> measure(count);
        for (std::size_t k = 0; k < count; ++k) {
            const double u = (static_cast<double>(row * points + k / side) + 0.5) / static_cast<double>(side);
            const double v = (static_cast<double>(k % side) + 0.5) / static_cast<double>(side);
            const Chart::Point p = chart.at(u, v);
            batch.set(k, chart.wo, p.wi);
            measure[k] = p.per_wi / static_cast<double>(side * side);
        }
        const std::vector<double> pdf = batch.run(fns_of(fast_fns(), model).pdf);
        for (std::size_t k = 0; k < count; ++k)
            if (measure[k] > 0)
                cells[row * kBins + (k % side) / points] += pdf[k] * measure[k] * static_cast<double>(kSamples);
    }
    const double sum = std::accumulate(cells.begin(), cells.end(), 0.0);
    cells.back() = std::max(static_cast<double>(kSamples) - sum, 0.0);
    return cells;
}

double run(const ModelCase& model, const Setting& setting, const std::vector<double>& sampled, Vec wo, std::uint64_t seed)
{
    const Chart chart = chart_of(model, setting, wo);
    return p_value(counted(model, sampled, chart, seed), foretold(model, setting.params, chart));
}

// Returns the limit for one run, so that kSignificance holds for all runs together.
double limit_of_run()
{
    double runs = 0;
    for (const ModelCase& model : model_cases())
        for (const Setting& setting : model.settings)
            runs += setting.integrable() ? static_cast<double>(views(model).size()) : 0;
    return 1 - std::pow(1 - kSignificance, 1 / runs);
}

class chi_square : public testing::TestWithParam<ModelCase> {};
std::string case_name(const testing::TestParamInfo<ModelCase>& info)
{
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(models, chi_square, testing::ValuesIn(model_cases()), case_name);

TEST_P(chi_square, samples_follow_the_pdf)
{
    const double limit = limit_of_run();
    std::uint64_t seed = 100;
    for (std::size_t s = 0; s < GetParam().settings.size(); ++s) {
        const Setting& setting = GetParam().settings[s];
        if (!setting.integrable())
            continue;
        for (Vec wo : views(GetParam())) {
            const double p = run(GetParam(), setting, setting.params, wo, ++seed);
            EXPECT_GT(p, limit) << "setting " << s << ", wo " << wo[0] << " " << wo[1] << " " << wo[2];
        }
    }
}

TEST(chi_square_power, sees_a_lobe_five_percent_too_wide)
{
    const ModelCase& model = model_case("ggx_aniso");
    const Setting& setting = model.settings[0];
    std::vector<double> wider = setting.params;
    wider[0] *= 1.05;
    EXPECT_LT(run(model, setting, wider, rounded(direction(0.8, 2.0)), 1), 1e-6);
}

TEST(chi_square_power, gamma_function_has_known_values)
{
    EXPECT_NEAR(gamma_q(0.5, 1.9207294), 0.05, 1e-7); // chi-square 3.841459, 1 degree of freedom
    EXPECT_NEAR(gamma_q(50, 62.1710562), 0.05, 1e-6); // 124.3421, 100 degrees
    EXPECT_NEAR(gamma_q(50, 38.9648), 0.95, 1e-4);
}

} // namespace
} // namespace burnish::test
