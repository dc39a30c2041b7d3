// The float versions of every model: the same bits on every instruction set, close to the double oracle, and
// finite everywhere.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <limits>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

class FloatModels : public testing::TestWithParam<ModelCase> {};
std::string case_name(const testing::TestParamInfo<ModelCase>& info)
{
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(models, FloatModels, testing::ValuesIn(model_cases()), case_name);

struct Function {
    RunFn fn;
    int outputs;
    const char* name;
};
std::vector<Function> runs_of(const ModelFns& fns)
{
    return {{fns.eval, 1, "eval"},
            {fns.pdf, 1, "pdf"},
            {fns.half_pdf, 1, "half_pdf"},
            {fns.sample, kSampleOutputs, "sample"}};
}

Batch random_samples(const Setting& setting, std::size_t n, std::uint64_t seed)
{
    Batch batch(setting.params, n);
    Random random(seed);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec wo = random.hemisphere();
        const double x = random.next(), y = random.next(), z = random.next();
        batch.set(k, wo, {x, y, z});
    }
    return batch;
}

// Random pairs, pairs near the mirror direction, and pairs that the model samples, which find the narrowest lobe.
Batch random_pairs(const ModelCase& model, const Setting& setting, bool halves, std::size_t n, std::uint64_t seed)
{
    const Batch draws = random_samples(setting, n, seed + 1000);
    const std::vector<double> s = draws.run(oracle_fns().models[model.index].sample, kSampleOutputs);
    const bool both_sides = (model.traits & kBothSides) != 0;
    Batch batch(setting.params, n);
    Random random(seed);
    for (std::size_t k = 0; k < n; ++k) {
        Vec wo = random.hemisphere();
        Vec wi = random.hemisphere();
        if (k % 4 == 0)
            wi = rounded(unit(Vec{-wo[0], -wo[1], wo[2]} + wi * 0.2));
        if (both_sides && k % 3 == 0)
            wi = wi * -1;
        if (k % 2 == 1 && s[6 * n + k] != 0)
            wo = draws.wo(k), wi = rounded({s[k], s[n + k], s[2 * n + k]});
        batch.set(k, wo, halves ? rounded(unit(wo + wi)) : wi);
    }
    return batch;
}

// Numbers that models are brought up to, and beyond: widths, exponents, tilts, indices. Every model gets them
// in every place.
std::vector<std::vector<double>> harsh_params()
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {{1e-3, 1e-3, 0, 0, 0, 1.5},    {1e-3, 1, 0, 0, 0, 1},
            {1, 1e-3, 0.6, -0.6, 2, 0.7},  {0, 0.5, 0, 0, 0, 1.0005},
            {0.5, 0, 0.3, 0.3, -3, 0},     {1, 1, 0, 0, 0, 1000},
            {1e-3, 1e-3, 0.6, 0.6, 1, 2},  {0.7, 0.1, 1.2, -1.2, 0.5, 1.3},
            {1e6, 1e6, 0, 0, 0, 1.5},      {2e4, 70, 1.5707963, 0, 0, 1},
            {-1, -1, 0, 1.5707963, 0, -1}, {nan, nan, 0, 0, 0, nan},
            {1e30, 1e-30, 0, 0, 0, 1e-30}, {0.3, 0.6, 3.1415927, 0, 0, 0.999}};
}
std::vector<Vec> harsh_directions()
{
    std::vector<Vec> list = {{0, 0, 1},  {1, 0, 0},    {0, 1, 0},     {0, 0, -1},
                             {-1, 0, 0}, {1e-8, 0, 1}, {0, -1e-8, 1}, {1e-20, 1e-20, 1}};
    for (double z : {1e-20, 1e-12, 1e-8, 1e-4, 0.1, 0.7, 0.9999999})
        for (double tiny : {0.0, 1e-8, -1e-8, 1e-20})
            for (double side : {1.0, -1.0}) {
                const double s = std::sqrt(1 - z * z);
                list.push_back({side * s, tiny, z}); // on a plane of symmetry, or beside it
                list.push_back({tiny, side * s, z});
                list.push_back({side * s, tiny, -z});
            }
    return list;
}

template <class Check> // check(batch, what)
void harsh_batches(const Check& check)
{
    const std::vector<Vec> directions = harsh_directions();
    const double numbers[] = {0, 0x1p-24, 0.25, 0.5, 0.75, 1 - 0x1p-24};
    for (const std::vector<double>& params : harsh_params()) {
        Batch pairs(params, directions.size() * directions.size());
        std::size_t k = 0;
        for (Vec wo : directions)
            for (Vec wi : directions)
                pairs.set(k++, wo, wi);
        check(pairs, false);
        Batch samples(params, directions.size() * 72);
        k = 0;
        for (Vec wo : directions)
            for (double x : numbers)
                for (double y : numbers)
                    for (double z : {0.0, 0.99})
                        samples.set(k++, wo, {x, y, z});
        check(samples, true);
    }
}

TEST_P(FloatModels, every_instruction_set_gives_the_same_bits)
{
    const auto compare = [&](const Batch& batch, bool samples) {
        const std::vector<Function> scalar = runs_of(float_fns()[0].models[GetParam().index]);
        for (std::size_t i = 1; i < float_fns().size(); ++i) {
            const std::vector<Function> simd = runs_of(float_fns()[i].models[GetParam().index]);
            for (std::size_t f = 0; f < simd.size(); ++f) {
                if (samples != (simd[f].outputs > 1))
                    continue;
                const std::vector<double> a = batch.run(scalar[f].fn, scalar[f].outputs),
                                          b = batch.run(simd[f].fn, simd[f].outputs);
                for (std::size_t k = 0; k < a.size(); ++k)
                    ASSERT_EQ(std::bit_cast<std::uint64_t>(a[k]), std::bit_cast<std::uint64_t>(b[k]))
                        << float_fns()[i].name << " " << simd[f].name << ": " << a[k] << " " << b[k];
            }
        }
    };
    for (const Setting& setting : GetParam().settings) {
        compare(random_pairs(GetParam(), setting, false, 4099, 41), false);
        compare(random_samples(setting, 4099, 42), true);
    }
    harsh_batches(compare);
}

TEST_P(FloatModels, degenerate_inputs_give_finite_results)
{
    const ModelFns& fns = float_fns().back().models[GetParam().index];
    harsh_batches([&](const Batch& batch, bool samples) {
        for (const Function& run : runs_of(fns)) {
            if (samples != (run.outputs > 1))
                continue;
            const std::vector<double> r = batch.run(run.fn, run.outputs);
            for (std::size_t k = 0; k < r.size(); ++k) {
                ASSERT_TRUE(std::isfinite(r[k])) << run.name << " " << k;
                ASSERT_TRUE(samples || r[k] >= 0) << run.name << " " << k;
            }
            const std::size_t n = static_cast<std::size_t>(batch.size());
            for (std::size_t k = 0; samples && k < n; ++k) {
                ASSERT_NEAR(r[k] * r[k] + r[n + k] * r[n + k] + r[2 * n + k] * r[2 * n + k], 1, 1e-5);
                ASSERT_TRUE(r[3 * n + k] >= 0 && r[4 * n + k] >= 0);
                ASSERT_TRUE(r[5 * n + k] >= 0 && r[5 * n + k] <= 1);
                ASSERT_LE(r[3 * n + k], (GetParam().traits & kBounded) != 0 ? 1 + 1e-5 : 1e30);
            }
        }
    });
}

// Distance in units of the last place of a float of the size of `truth`, or of 1e-24 where truth is smaller: what is left
// of a lobe there may be cut off.
double ulps(double value, double truth)
{
    int exponent;
    std::frexp(std::max(std::abs(truth), 1e-24), &exponent);
    return std::abs(value - truth) / std::ldexp(1.0, exponent - 24);
}

// The largest of many errors, and that which one in a thousand exceeds.
struct Errors {
    double largest, common;
};
Errors errors_of(std::vector<double>& all)
{
    std::sort(all.begin(), all.end());
    return all.empty() ? Errors{} : Errors{all.back(), all[all.size() - 1 - all.size() / 1000]};
}

// A refraction's cosine is a difference of nearly equal numbers where the facet is seen edge on; f is small
// there. Ulps of the value for densities; for samples, 2^-24 of a component of the direction and of the
// weight. Twice what was seen, rounded up. Exponentials multiply the error of their argument; where a view
// grazes, maps from the square to visible normals have a pole, and the largest error of a direction says how
// near the random numbers came to it.
constexpr std::size_t kErrors = 7;
struct Bound {
    const char* model;
    Errors of[kErrors]; // eval, pdf, half_pdf; of samples: direction, weight, density, cosine
};
constexpr Bound kBounds[] = {
    {"lambert", {{1, 1}, {3, 3}, {1, 1}, {89, 18}, {1, 1}, {1, 1}, {1, 1}}},
    {"ggx", {{29, 20}, {28, 20}, {20, 11}, {31, 15}, {350, 38}, {1, 1}, {1, 1}}},
    {"ggx_aniso", {{32, 22}, {30, 21}, {22, 14}, {150, 26}, {850, 54}, {1, 1}, {1, 1}}},
    {"ggx_aniso_separable", {{31, 22}, {30, 21}, {22, 13}, {130, 23}, {150, 45}, {1, 1}, {1, 1}}},
    {"beckmann", {{160, 99}, {150, 94}, {110, 55}, {16, 13}, {59, 26}, {1, 1}, {1, 1}}},
    {"ward", {{160, 94}, {160, 95}, {87, 56}, {21, 13}, {190, 23}, {1, 1}, {1, 1}}},
    {"ward_cheap", {{1,1},{1,1},{1,1},{1,1},{1,1},{1,1},{1,1}}},
    {"ashikhmin_shirley", {{600, 180}, {320, 160}, {130, 70}, {21, 10}, {350, 37}, {1, 1}, {1, 1}}},
    {"heidrich_seidel", {{670, 67}, {1, 1}, {1, 1}, {9, 5}, {710, 230}, {1, 1}, {1, 1}}},
    {"ellipsoid", {{59, 30}, {47, 30}, {34, 24}, {150, 32}, {800, 120}, {1, 1}, {1, 1}}},
    {"ellipsoid_dielectric", {{1300000, 2400}, {1200000, 2500}, {1, 1}, {160, 27}, {320, 93}, {1, 1}, {1, 1}}},
};

// Errors of float samples: direction, weight, cosine in 2^-24, density in ulp. Both versions reject the same samples, but at
// the horizon, of wi or of the half vector, where either answer is right.
void sample_errors(const ModelCase& model, const Setting& setting, std::size_t n, std::vector<double>* all)
{
    const Batch samples = random_samples(setting, n, 44);
    const std::vector<double> t = samples.run(oracle_fns().models[model.index].sample, kSampleOutputs),
                              v = samples.run(float_fns()[0].models[model.index].sample, kSampleOutputs);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec wi = {t[k], t[n + k], t[2 * n + k]};
        if (t[6 * n + k] != v[6 * n + k]) {
            const double half_z = unit(samples.wo(k) + wi)[2];
            ASSERT_LE(std::min({std::abs(wi[2]), std::abs(half_z), t[5 * n + k]}), 1e-5) << "rejected by one alone";
            continue;
        }
        for (std::size_t c = 0; c < 3; ++c)
            all[3].push_back(std::abs(v[c * n + k] - wi[c]) * 0x1p24);
        all[4].push_back(std::abs(v[3 * n + k] - t[3 * n + k]) * 0x1p24);
        all[5].push_back(ulps(v[4 * n + k], t[4 * n + k]));
        all[6].push_back(std::abs(v[5 * n + k] - t[5 * n + k]) * 0x1p24);
    }
}

TEST_P(FloatModels, stay_close_to_the_double_oracle)
{
    const std::vector<Function> exact = runs_of(oracle_fns().models[GetParam().index]),
                                narrow = runs_of(float_fns()[0].models[GetParam().index]);
    std::vector<double> all[kErrors]; // as in Bound
    for (Setting setting : GetParam().settings) {
        for (double& p : setting.params)
            p = rounded({p, 0, 0})[0];
        const std::size_t n = 20000;
        for (std::size_t f = 0; f < 3; ++f) {
            const Batch pairs = random_pairs(GetParam(), setting, f == 2, n, 43);
            const std::vector<double> truth = pairs.run(exact[f].fn), value = pairs.run(narrow[f].fn);
            for (std::size_t k = 0; k < n; ++k)
                all[f].push_back(ulps(value[k], truth[k]));
        }
        ASSERT_NO_FATAL_FAILURE(sample_errors(GetParam(), setting, n, all));
    }
    const Bound* bound = nullptr;
    for (const Bound& b : kBounds)
        if (GetParam().name == std::string(b.model))
            bound = &b;
    ASSERT_NE(bound, nullptr) << "a new model needs its bounds";
    const char* names[] = {"eval", "pdf", "half_pdf", "direction", "weight", "density", "cosine"};
    for (std::size_t f = 0; f < kErrors; ++f) {
        const Errors seen = errors_of(all[f]);
        std::printf("%s %s: largest error %.1f ulp, one in a thousand above %.1f\n", GetParam().name,
                    names[f], seen.largest, seen.common);
        EXPECT_LE(seen.largest, bound->of[f].largest) << names[f];
        EXPECT_LE(seen.common, bound->of[f].common) << names[f];
    }
}

} // namespace
} // namespace burnish::test
