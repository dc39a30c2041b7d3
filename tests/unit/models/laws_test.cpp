// What physics and probability ask of every model of model_list.def.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

class ModelLaws : public testing::TestWithParam<ModelCase> {};
std::string case_name(const testing::TestParamInfo<ModelCase>& info)
{
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(models, ModelLaws, testing::ValuesIn(model_cases()), case_name);

std::string label(const Setting& setting, Vec wo)
{
    return fmt::format("params {}, wo {}", fmt::join(setting.params, " "), fmt::join(wo, " "));
}

TEST_P(ModelLaws, albedo_is_at_most_one)
{
    if ((GetParam().traits & kEnergy) == 0)
        GTEST_SKIP() << "the model does not conserve energy";
    for (const Setting& setting : GetParam().settings)
        for (Vec wo : views(GetParam())) {
            const double albedo = integral(GetParam(), setting, wo, Integrand::albedo, 192);
            EXPECT_LE(albedo, 1 + 2e-3) << label(setting, wo);
            EXPECT_GE(albedo, 0.1) << label(setting, wo);
        }
}

TEST_P(ModelLaws, is_reciprocal)
{
    if ((GetParam().traits & kReciprocal) == 0)
        GTEST_SKIP() << "the model is not reciprocal";
    const ModelFns& fns = oracle_fns().models[GetParam().index];
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

// Over wi, with what is rejected, the density adds up to one.
TEST_P(ModelLaws, pdf_and_rejections_add_up_to_one)
{
    const ModelFns& fns = float_fns().back().models[GetParam().index];
    for (const Setting& setting : GetParam().settings)
        for (Vec wo : views(GetParam())) {
            Random random(12);
            const std::size_t n = 20000;
            Batch batch(setting.params, n);
            for (std::size_t k = 0; k < n; ++k)
                batch.set(k, wo, {random.next(), random.next(), random.next()});
            const std::vector<double> samples = batch.run(fns.sample, kSampleOutputs);
            double valid = 0;
            for (std::size_t k = 0; k < n; ++k)
                valid += samples[6 * n + k];
            const double share = valid / static_cast<double>(n);
            const double deviation = std::sqrt(share * (1 - share) / static_cast<double>(n));
            const int grid =
                (GetParam().traits & kBothSides) != 0 ? 512 : 192; // refraction is narrow at grazing views
            const double total = integral(GetParam(), setting, wo, Integrand::pdf, grid);
            EXPECT_NEAR(total, share, 5 * deviation + 2e-3) << label(setting, wo);
        }
}

TEST_P(ModelLaws, half_vector_density_integrates_to_one)
{
    if ((GetParam().traits & kHalf) == 0)
        GTEST_SKIP() << "the model samples no half vectors";
    for (const Setting& setting : GetParam().settings)
        for (Vec wo : views(GetParam()))
            EXPECT_NEAR(integral(GetParam(), setting, wo, Integrand::half_pdf, 192), 1, 1e-3)
                << label(setting, wo);
}

// weight = eval cos / pdf, with the same density that pdf gives, and the direction it gives is unit and above
// the horizon.
TEST_P(ModelLaws, samples_agree_with_eval_and_pdf)
{
    const ModelFns& fns = oracle_fns().models[GetParam().index];
    const bool cosine_inside =
        std::string(GetParam().name) == "heidrich_seidel"; // its eval is BRDF times cosine
    for (const Setting& setting : GetParam().settings)
        for (Vec wo : views(GetParam())) {
            Random random(13);
            const std::size_t n = 2048;
            Batch batch(setting.params, n), pairs(setting.params, n);
            for (std::size_t k = 0; k < n; ++k)
                batch.set(k, wo, {random.next(), random.next(), random.next()});
            const std::vector<double> s = batch.run(fns.sample, kSampleOutputs);
            for (std::size_t k = 0; k < n; ++k)
                pairs.set(k, wo, {s[k], s[n + k], s[2 * n + k]});
            const std::vector<double> f = pairs.run(fns.eval), pdf = pairs.run(fns.pdf);
            for (std::size_t k = 0; k < n; ++k) {
                const Vec wi = {s[k], s[n + k], s[2 * n + k]};
                ASSERT_NEAR(dot(wi, wi), 1, 1e-5);
                if (s[6 * n + k] == 0) {
                    ASSERT_EQ(s[3 * n + k], 0);
                    continue;
                }
                const double cosine = cosine_inside ? 1 : std::abs(wi[2]);
                // wo is unit to float only, and wi leaves it by as much: narrow lobes and grazing views
                // multiply that.
                ASSERT_NEAR(s[4 * n + k] / pdf[k], 1, 2e-3) << label(setting, wo);
                ASSERT_NEAR(s[3 * n + k] * pdf[k], f[k] * cosine, 2e-3 * f[k] * cosine) << label(setting, wo);
            }
        }
}

TEST_P(ModelLaws, weights_are_at_most_one)
{
    if ((GetParam().traits & kBounded) == 0)
        GTEST_SKIP() << "the model's weights have no such bound";
    double largest = 0;
    for (const IsaFns& isa : {float_fns().back(), oracle_fns()})
        for (const Setting& setting : GetParam().settings) {
            Random random(14);
            const std::size_t n = 20000;
            Batch batch(setting.params, n);
            for (std::size_t k = 0; k < n; ++k) {
                const Vec wo = random.hemisphere();
                batch.set(k, wo, {random.next(), random.next(), random.next()});
            }
            const std::vector<double> s = batch.run(isa.models[GetParam().index].sample, kSampleOutputs);
            for (std::size_t k = 0; k < n; ++k)
                largest = std::max(largest, s[3 * n + k]);
        }
    std::printf("%s: largest weight %.9g\n", GetParam().name, largest);
    EXPECT_LE(largest, 1 + 1e-5);
    EXPECT_GT(largest, 0.9);
}

} // namespace
} // namespace burnish::test
