// Float versions of every model: equal bits on every instruction set, close to the double oracle, and finite everywhere.
#include <algorithm>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "tests/unit/models/float_error.h"
#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

class float_models : public testing::TestWithParam<ModelCase> {};
std::string case_name(const testing::TestParamInfo<ModelCase>& info)
{
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(models, float_models, testing::ValuesIn(model_cases()), case_name);

std::vector<const Kernel*> kernels_of(const IsaFns& isa, const ModelCase& model)
{
    const ModelFns fns = fns_of(isa, model);
    return {&fns.eval, &fns.pdf, &fns.half_pdf, &fns.sample};
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

// Returns random pairs, pairs near the mirror direction, and pairs sampled from the model, which find the narrowest lobe.
Batch random_pairs(const ModelCase& model, const Setting& setting, bool halves, std::size_t n, std::uint64_t seed)
{
    const Batch draws = random_samples(setting, n, seed + 1000);
    const std::vector<double> s = draws.run(fns_of(oracle_fns(), model).sample);
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

// Returns parameters at and beyond the limits that models clamp to: widths, exponents, tilts, indices. Every model gets them in every
// position.
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
    std::vector<Vec> list = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, {1e-8, 0, 1}, {0, -1e-8, 1}, {1e-20, 1e-20, 1}};
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

TEST_P(float_models, every_instruction_set_gives_the_same_bits)
{
    const auto compare = [&](const Batch& batch, bool samples) {
        const std::vector<const Kernel*> scalar = kernels_of(float_fns()[0], GetParam());
        for (std::size_t i = 1; i < float_fns().size(); ++i) {
            const std::vector<const Kernel*> simd = kernels_of(float_fns()[i], GetParam());
            for (std::size_t f = 0; f < simd.size(); ++f) {
                if (samples != (simd[f]->outputs > 1))
                    continue;
                const std::vector<double> a = batch.run(*scalar[f]), b = batch.run(*simd[f]);
                for (std::size_t k = 0; k < a.size(); ++k)
                    ASSERT_EQ(std::bit_cast<std::uint64_t>(a[k]), std::bit_cast<std::uint64_t>(b[k]))
                        << float_fns()[i].name << " " << simd[f]->name << ": " << a[k] << " " << b[k];
            }
        }
    };
    for (const Setting& setting : GetParam().settings) {
        compare(random_pairs(GetParam(), setting, false, 4099, 41), false);
        compare(random_samples(setting, 4099, 42), true);
    }
    harsh_batches(compare);
}

TEST_P(float_models, degenerate_inputs_give_finite_results)
{
    harsh_batches([&](const Batch& batch, bool samples) {
        for (const Kernel* run : kernels_of(fast_fns(), GetParam())) {
            if (samples != (run->outputs > 1))
                continue;
            const std::vector<double> r = batch.run(*run);
            for (std::size_t k = 0; k < r.size(); ++k) {
                ASSERT_TRUE(std::isfinite(r[k])) << run->name << " " << k;
                ASSERT_TRUE(samples || r[k] >= 0) << run->name << " " << k;
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

// Bounds in multiples of ulp plus sway: twice the observed errors, rounded up. An ellipsoid's sample evaluates its density at the rounded
// normal, which a tilted lobe of width 0.001 magnifies.
constexpr std::size_t kKinds = 7;
constexpr const char* kKindNames[kKinds] = {"eval", "pdf", "half_pdf", "direction", "weight", "density", "cosine"};
struct Bound {
    const char* model;
    Extent of[kKinds];
};
constexpr Bound kBounds[] = {
    {"lambert", {{1, 1}, {3, 1}, {1, 1}, {3, 2}, {1, 1}, {3, 3}, {4, 2}}},
    {"ggx", {{9, 5}, {9, 6}, {4, 3}, {52, 5}, {12, 6}, {10, 6}, {41, 3}}},
    {"ggx_aniso", {{8, 4}, {9, 4}, {5, 3}, {41, 5}, {13, 6}, {15, 5}, {35, 3}}},
    {"ggx_aniso_separable", {{7, 4}, {8, 4}, {4, 3}, {24, 5}, {16, 4}, {8, 5}, {17, 3}}},
    {"beckmann", {{7, 4}, {6, 4}, {28, 2}, {10, 5}, {13, 6}, {21, 6}, {3, 2}}},
    {"ward", {{8, 2}, {7, 4}, {47, 2}, {14, 5}, {22, 8}, {10, 5}, {4, 2}}},
    {"ward_cheap", {{6, 3}, {6, 3}, {7, 2}, {10, 6}, {10, 5}, {8, 4}, {5, 2}}},
    {"ashikhmin_shirley", {{14, 4}, {13, 4}, {6, 3}, {7, 3}, {16, 10}, {6, 3}, {3, 2}}},
    {"charlie", {{23, 11}, {1, 1}, {3, 2}, {5, 3}, {39, 20}, {1, 1}, {4, 2}}},
    {"heidrich_seidel", {{24, 14}, {1, 1}, {1, 1}, {5, 3}, {120, 21}, {1, 1}, {4, 2}}},
    {"ellipsoid", {{12, 5}, {9, 5}, {7, 3}, {94, 9}, {60, 10}, {1060, 500}, {12, 3}}},
    {"ellipsoid_correlated", {{12, 5}, {9, 5}, {7, 3}, {285, 6}, {121, 8}, {1290, 565}, {215, 6}}},
    {"ellipsoid_dielectric", {{7, 4}, {8, 4}, {1, 1}, {31, 5}, {54, 8}, {790, 250}, {6, 3}}},
};

// Adds the errors of samples. Direction, weight and cosine count in units of 2^-24. Both versions reject the same samples, except where wi
// or the half vector lies at the horizon and either answer is right.
void sample_errors(const ModelCase& model, const Setting& setting, std::size_t n, Errors* of)
{
    const Batch samples = random_samples(setting, n, 44);
    const Kernel& exact = fns_of(oracle_fns(), model).sample;
    const std::vector<double> t = samples.run(exact), moved = sway(exact, samples.arguments()),
                              v = samples.run(fns_of(float_fns()[0], model).sample);
    for (std::size_t k = 0; k < n; ++k) {
        if (t[6 * n + k] != v[6 * n + k]) {
            const Vec wi = {t[k], t[n + k], t[2 * n + k]};
            const double half_z = unit(samples.wo(k) + wi)[2];
            ASSERT_LE(std::min({std::abs(wi[2]), std::abs(half_z), t[5 * n + k]}), 1e-5) << "rejected by one alone";
            continue;
        }
        for (std::size_t c = 0; c < 6; ++c) {
            const std::size_t at = c * n + k;
            of[c < 3 ? 3 : c + 1].add(v[at], t[at], c == 4 ? ulp(t[at]) : 0x1p-24, moved[at]);
        }
    }
}

TEST_P(float_models, stay_close_to_the_double_oracle)
{
    const std::vector<const Kernel*> exact = kernels_of(oracle_fns(), GetParam()), narrow = kernels_of(float_fns()[0], GetParam());
    Errors of[kKinds];
    for (Setting setting : GetParam().settings) {
        for (double& p : setting.params)
            p = rounded({p, 0, 0})[0];
        const std::size_t n = 20000;
        for (std::size_t f = 0; f < 3; ++f) {
            const Batch pairs = random_pairs(GetParam(), setting, f == 2, n, 43);
            const std::vector<double> reference = pairs.run(*exact[f]), value = pairs.run(*narrow[f]),
                                      moved = sway(*exact[f], pairs.arguments());
            for (std::size_t k = 0; k < n; ++k)
                of[f].add(value[k], reference[k], ulp(reference[k]), moved[k]);
        }
        ASSERT_NO_FATAL_FAILURE(sample_errors(GetParam(), setting, n, of));
    }
    const Bound* bound = nullptr;
    for (const Bound& b : kBounds)
        if (GetParam().name == std::string(b.model))
            bound = &b;
    EXPECT_NE(bound, nullptr) << "a new model needs a line of kBounds: twice the second pair of each line that follows";
    for (std::size_t f = 0; f < kKinds; ++f)
        of[f].expect_within(bound ? bound->of[f] : Extent{0, 0}, GetParam().name, kKindNames[f]);
}

} // namespace
} // namespace burnish::test
