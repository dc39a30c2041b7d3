// Physical and statistical laws for every model of shading/models.def.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <iterator>
#include <numbers>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

std::vector<ModelCase> models_with(unsigned traits)
{
    std::vector<ModelCase> list;
    std::copy_if(model_cases().begin(), model_cases().end(), std::back_inserter(list),
                 [&](const ModelCase& model) { return (model.traits & traits) == traits; });
    return list;
}
std::string case_name(const testing::TestParamInfo<ModelCase>& info)
{
    return info.param.name;
}

// All models satisfy model_laws. For models that break another law, model_limits or dielectric_vectors states the replacement.
#define BN_LAWS(suite, traits)                                                                                                             \
    class suite : public testing::TestWithParam<ModelCase> {};                                                                             \
    INSTANTIATE_TEST_SUITE_P(models, suite, testing::ValuesIn(models_with(traits)), case_name);
BN_LAWS(model_laws, kNoTraits)
BN_LAWS(energy_laws, kEnergy)
BN_LAWS(reciprocity_laws, kReciprocal)
BN_LAWS(half_vector_laws, kHalf)
BN_LAWS(weight_laws, kBounded)
#undef BN_LAWS

std::vector<Setting> integrable_settings(const ModelCase& model)
{
    std::vector<Setting> list;
    std::copy_if(model.settings.begin(), model.settings.end(), std::back_inserter(list),
                 [](const Setting& setting) { return setting.integrable(); });
    return list;
}

std::string label(const Setting& setting, Vec wo)
{
    return fmt::format("params {}, wo {}", fmt::join(setting.params, " "), fmt::join(wo, " "));
}

TEST_P(energy_laws, albedo_is_at_most_one)
{
    for (const Setting& setting : integrable_settings(GetParam()))
        for (Vec wo : views(GetParam())) {
            const double albedo = integral(GetParam(), setting, wo, Integrand::albedo, 192);
            EXPECT_LE(albedo, 1 + 2e-3) << label(setting, wo);
            EXPECT_GE(albedo, 0.1) << label(setting, wo);
        }
}

TEST_P(reciprocity_laws, is_reciprocal)
{
    const ModelFns fns = fns_of(oracle_fns(), GetParam());
    for (const Setting& setting : GetParam().settings) {
        Random random(11);
        const std::size_t n = 4096;
        Batch there(setting.params, n), back(setting.params, n);
        for (std::size_t k = 0; k < n; ++k) {
            const Vec wo = unit(random.hemisphere()), wi = unit(random.hemisphere());
            there.set(k, wo, wi);
            back.set(k, wi, wo);
        }
        const std::vector<double> f = there.run(fns.eval), g = back.run(fns.eval);
        for (std::size_t k = 0; k < n; ++k)
            ASSERT_NEAR(f[k], g[k], 1e-12 * f[k]) << label(setting, {});
    }
}

// The density over wi and the rejected part add up to one.
TEST_P(model_laws, pdf_and_rejections_add_up_to_one)
{
    const ModelFns fns = fns_of(fast_fns(), GetParam());
    for (const Setting& setting : integrable_settings(GetParam()))
        for (Vec wo : views(GetParam())) {
            Random random(12);
            const std::size_t n = 20000;
            Batch batch(setting.params, n);
            for (std::size_t k = 0; k < n; ++k)
                batch.set(k, wo, {random.next(), random.next(), random.next()});
            const std::vector<double> samples = batch.run(fns.sample);
            double valid = 0;
            for (std::size_t k = 0; k < n; ++k)
                valid += samples[6 * n + k];
            const double share = valid / static_cast<double>(n);
            const double deviation = std::sqrt(share * (1 - share) / static_cast<double>(n));
            const int grid = (GetParam().traits & kBothSides) != 0 ? 512 : 192; // refraction is narrow at grazing views
            const double total = integral(GetParam(), setting, wo, Integrand::pdf, grid);
            EXPECT_NEAR(total, share, 5 * deviation + 2e-3) << label(setting, wo);
        }
}

TEST_P(half_vector_laws, half_vector_density_integrates_to_one)
{
    for (const Setting& setting : integrable_settings(GetParam()))
        for (Vec wo : views(GetParam()))
            EXPECT_NEAR(integral(GetParam(), setting, wo, Integrand::half_pdf, 192), 1, 1e-3) << label(setting, wo);
}

// weight = eval cos / pdf, with the density that pdf returns. Directions are unit and above the horizon.
TEST_P(model_laws, samples_agree_with_eval_and_pdf)
{
    const ModelFns fns = fns_of(oracle_fns(), GetParam());
    const bool cosine_inside = std::string(GetParam().name) == "heidrich_seidel"; // its eval includes the cosine
    for (const Setting& setting : GetParam().settings)
        for (Vec view : views(GetParam())) {
            const Vec wo = unit(view); // views are unit to float precision only
            Random random(13);
            const std::size_t n = 2048;
            Batch batch(setting.params, n), pairs(setting.params, n);
            for (std::size_t k = 0; k < n; ++k)
                batch.set(k, wo, {random.next(), random.next(), random.next()});
            const std::vector<double> s = batch.run(fns.sample);
            for (std::size_t k = 0; k < n; ++k)
                pairs.set(k, wo, {s[k], s[n + k], s[2 * n + k]});
            const std::vector<double> f = pairs.run(fns.eval), pdf = pairs.run(fns.pdf);
            for (std::size_t k = 0; k < n; ++k) {
                const Vec wi = {s[k], s[n + k], s[2 * n + k]};
                ASSERT_NEAR(dot(wi, wi), 1, 2e-8); // fits of logarithms leave errors of 1e-8 in half vectors
                if (s[6 * n + k] == 0) {
                    ASSERT_EQ(s[3 * n + k], 0);
                    continue;
                }
                const double cosine = cosine_inside ? 1 : std::abs(wi[2]);
                ASSERT_NEAR(s[4 * n + k] / pdf[k], 1, 1e-6) << label(setting, wo);
                ASSERT_NEAR(s[3 * n + k] * pdf[k], f[k] * cosine, 1e-6 * f[k] * cosine) << label(setting, wo);
            }
        }
}

TEST_P(weight_laws, weights_are_at_most_one)
{
    double largest = 0;
    for (const IsaFns& isa : {fast_fns(), oracle_fns()})
        for (const Setting& setting : GetParam().settings) {
            Random random(14);
            const std::size_t n = 20000;
            Batch batch(setting.params, n);
            for (std::size_t k = 0; k < n; ++k) {
                const Vec wo = random.hemisphere();
                batch.set(k, wo, {random.next(), random.next(), random.next()});
            }
            const std::vector<double> s = batch.run(fns_of(isa, GetParam()).sample);
            for (std::size_t k = 0; k < n; ++k)
                largest = std::max(largest, s[3 * n + k]);
        }
    std::printf("%s: largest weight %.9g\n", GetParam().name, largest);
    EXPECT_LE(largest, 1 + 1e-5);
    EXPECT_GT(largest, 0.9);
}

// Replacements for the laws that models break by nature.

// Calls fn(wo, wi, sample's numbers) for many valid samples of every setting.
template <class Fn> void each_sample(const ModelCase& model, const Fn& fn)
{
    for (const Setting& setting : model.settings) {
        Random random(15);
        const std::size_t n = 20000;
        Batch batch(setting.params, n);
        std::vector<Vec> wo(n);
        for (std::size_t k = 0; k < n; ++k) {
            wo[k] = unit(random.hemisphere());
            batch.set(k, wo[k], {random.next(), random.next(), random.next()});
        }
        const std::vector<double> s = batch.run(fns_of(oracle_fns(), model).sample);
        for (std::size_t k = 0; k < n; ++k)
            if (s[6 * n + k] != 0)
                fn(setting, wo[k], Vec{s[k], s[n + k], s[2 * n + k]}, s[3 * n + k]);
    }
}

// Weights are (wo.h) h.z^3 sqrt(wi.z / wo.z), without h.z^3 for the cheap exponent: at most 1 / sqrt(wo.z), which exceeds 1.
TEST(model_limits, weights_of_ward_grow_as_the_root_of_the_cosine)
{
    struct Case {
        const char* name;
        int power;
    };
    for (const Case& c : {Case{"ward", 3}, {"ward_cheap", 0}}) {
        double largest = 0;
        each_sample(model_case(c.name), [&](const Setting&, Vec wo, Vec wi, double weight) {
            const Vec h = unit(wo + wi);
            const double root = std::sqrt(std::max(wi[2], 1e-4) * std::max(wo[2], 1e-4));
            const double expected = dot(wo, h) * std::pow(h[2], c.power) * wi[2] / root;
            ASSERT_NEAR(weight, expected, 1e-6 * expected) << c.name;
            ASSERT_LE(weight, 1 / std::sqrt(std::max(wo[2], 1e-4)) + 1e-6) << c.name;
            largest = std::max(largest, weight);
        });
        std::printf("%s: largest weight %.9g\n", c.name, largest);
        EXPECT_GT(largest, 2);
    }
}

// With the cheap exponent a part exp(-2 / alpha^2) of the half vectors lies below the horizon and is rejected.
TEST(model_limits, wide_lobes_of_the_cheap_exponent_lose_half_vectors)
{
    const ModelCase& model = model_case("ward_cheap");
    for (double alpha : {1.0, 1.5}) {
        const Setting setting = {{alpha, alpha, 0, 0, 0, 0}, {alpha, alpha}};
        EXPECT_NEAR(integral(model, setting, {0, 0, 1}, Integrand::half_pdf, 256), 1 - std::exp(-2 / (alpha * alpha)), 1e-4);
        const std::size_t n = 100000;
        Random random(17);
        Batch batch(setting.params, n);
        for (std::size_t k = 0; k < n; ++k)
            batch.set(k, {0, 0, 1}, {random.next(), random.next(), random.next()});
        const std::vector<double> s = batch.run(fns_of(float_fns()[0], model).sample);
        double valid = 0;
        for (std::size_t k = 0; k < n; ++k)
            valid += s[6 * n + k];
        // Seen along the normal, light leaves the surface where 1 - h.z is below 1 - sqrt(1/2).
        const double above = 1 - std::exp(-2 * (1 - std::sqrt(.5)) / (alpha * alpha));
        EXPECT_NEAR(valid / static_cast<double>(n), above, 6e-3);
        EXPECT_NEAR(integral(model, setting, {0, 0, 1}, Integrand::pdf, 256), above, 2e-3);
    }
}

// Albedo at views towards grazing, for widths .4 and .2; double-precision quadrature of Ward's formulas (2000^2 half vectors).
TEST(model_limits, ward_gains_energy_at_grazing_views)
{
    const Setting setting = {{.4, .2, 0, 0, 0, 0}, {.4, .2}};
    const double cases[][3] = {{.01, .62891, .86117}, {.005, .86873, 1.19385}, {1e-4, 6.00143, 8.27724}};
    for (const auto& c : cases) {
        const Vec wo = {std::sqrt(1 - c[0] * c[0]), 0, c[0]};
        EXPECT_NEAR(integral(model_case("ward"), setting, wo, Integrand::albedo, 768), c[1], 3e-3 * c[1]);
        EXPECT_NEAR(integral(model_case("ward_cheap"), setting, wo, Integrand::albedo, 768), c[2], 3e-3 * c[2]);
    }
}

// Weights G2 (wo.h) / (wo.z h.z) are bounded by masking alone, G2 <= G1(wo). The rational Lambda exceeds the bound by 6e-5, where it dips
// below 0 at its end.
TEST(model_limits, weights_of_beckmann_are_bounded_by_its_masking)
{
    double largest = 0;
    const ModelCase& model = model_case("beckmann");
    each_sample(model, [&](const Setting& setting, Vec wo, Vec wi, double weight) {
        const Vec h = unit(wo + wi);
        const double lambda = call(oracle_fns(), "beckmann_lambda", {setting.params[0], setting.params[1], wo[0], wo[1], wo[2]})[0];
        ASSERT_LE(weight, dot(wo, h) / (h[2] * wo[2] * (1 + lambda)) * (1 + 7e-5));
        largest = std::max(largest, weight);
    });
    std::printf("beckmann: largest weight %.9g\n", largest);
    EXPECT_GT(largest, 2);
}

// Threads are not normalised. The diffuse term's integral over the hemisphere is pi^2 / 2 for every view. The gloss, seen along the normal,
// integrates to half the surface integral of sine^p, pi^(3/2) Gamma(p / 2 + 1) / Gamma(p / 2 + 3 / 2).
TEST(model_limits, threads_reflect_their_known_integrals)
{
    const ModelCase& model = model_case("heidrich_seidel");
    const auto total = [&](std::vector<double> params, Vec wo) {
        params.resize(kMaxParams);
        const int grid = 1024;
        Batch batch(params, grid * grid);
        for (std::size_t k = 0; k < grid * grid; ++k) { // uniform over the hemisphere
            const double z = (static_cast<double>(k / grid) + .5) / grid,
                         turn = 2 * std::numbers::pi * (static_cast<double>(k % grid) + .5) / grid;
            const double s = std::sqrt(1 - z * z);
            batch.set(k, wo, {s * std::cos(turn), s * std::sin(turn), z});
        }
        double sum = 0;
        for (double f : batch.run(fns_of(fast_fns(), model).eval))
            sum += f;
        return sum * 2 * std::numbers::pi / (grid * grid);
    };
    const double pi = std::numbers::pi;
    for (Vec wo : views(model))
        EXPECT_NEAR(total({1, 0, 20}, wo), pi * pi / 2, 1e-4);
    for (double p : {1.0, 5.5, 20.0, 300.0}) {
        const double known = std::pow(pi, 1.5) * std::exp(std::lgamma(p / 2 + 1) - std::lgamma(p / 2 + 1.5));
        EXPECT_NEAR(total({0, 1, p}, {0, 0, 1}), known, 3e-4 * known) << p;
    }
}

// Only the gloss is reciprocal. Samples are uniform: weight = 2 pi eval, at most 2 pi (kd + ks).
TEST(model_limits, threads_are_reciprocal_in_their_gloss_alone)
{
    const ModelCase& model = model_case("heidrich_seidel");
    const ModelFns fns = fns_of(oracle_fns(), model);
    for (const auto& params : {std::vector<double>{0, .6, 20, 0, 0, 0}, {.3, .6, 20, 0, 0, 0}}) {
        Random random(16);
        const std::size_t n = 4096;
        Batch there(params, n), back(params, n);
        for (std::size_t k = 0; k < n; ++k) {
            const Vec wo = unit(random.hemisphere()), wi = unit(random.hemisphere());
            there.set(k, wo, wi);
            back.set(k, wi, wo);
        }
        const std::vector<double> f = there.run(fns.eval), g = back.run(fns.eval);
        double apart = 0;
        for (std::size_t k = 0; k < n; ++k)
            apart = std::max(apart, std::abs(f[k] - g[k]));
        if (params[0] == 0) {
            EXPECT_LE(apart, 1e-12);
        } else {
            EXPECT_GT(apart, .2);
        }
    }
    double largest = 0;
    each_sample(model, [&](const Setting& setting, Vec, Vec, double weight) {
        ASSERT_LE(weight, 2 * std::numbers::pi * (setting.params[0] + setting.params[1]) + 1e-9);
        largest = std::max(largest, weight / (2 * std::numbers::pi * (setting.params[0] + setting.params[1])));
    });
    EXPECT_GT(largest, .95);
}

} // namespace
} // namespace burnish::test
