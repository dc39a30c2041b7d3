// KHR_materials_sheen: its lobe against the extension's text, its fits against integrals, both renderers against each other.
#include <gtest/gtest.h>

#include <cmath>

#include "shading/models/charlie.k.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kPi = 3.14159265358979324;
constexpr double kSheenSigmas = 4.5;

// The extension's equations in doubles (KHR_materials_sheen, "Sheen distribution" and "Sheen visibility").
double sheen_lambda_log(double x, double alpha)
{
    const double t = (1.0 - alpha) * (1.0 - alpha);
    const double a = 21.5473 * (1.0 - t) + 25.3245 * t, b = 3.82987 * (1.0 - t) + 3.32435 * t, c = 0.19823 * (1.0 - t) + 0.16801 * t;
    const double d = -1.97760 * (1.0 - t) - 1.27393 * t, e = -4.32054 * (1.0 - t) - 4.85967 * t;
    return a / (1.0 + b * std::pow(x, c)) + d * x + e;
}

double sheen_lambda(double cosine, double alpha)
{
    if (cosine < 0.5)
        return std::exp(sheen_lambda_log(cosine, alpha));
    return std::exp(2.0 * sheen_lambda_log(0.5, alpha) - sheen_lambda_log(1.0 - cosine, alpha));
}

double sheen_value(const glm::dvec3& o, const glm::dvec3& i, double alpha)
{
    const glm::dvec3 h = glm::normalize(o + i);
    const double sine = std::sqrt(h.x * h.x + h.y * h.y);
    const double density = (2.0 + 1.0 / alpha) * std::pow(sine, 1.0 / alpha) / (2.0 * kPi);
    return density / (4.0 * o.z * i.z * (1.0 + sheen_lambda(o.z, alpha) + sheen_lambda(i.z, alpha)));
}

glm::dvec3 direction(double cosine, double turn)
{
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

struct SheenIntegral {
    double albedo;
    glm::dvec3 mean; // direction of the reflected light, shorter than 1
};

// Integrates in equal steps of the squared root of the cosine, since values rise towards the horizon.
SheenIntegral sheen_integral(double cosine, double alpha)
{
    constexpr int kHeights = 300, kTurns = 200;
    const glm::dvec3 o = direction(cosine, 0.0);
    double sum = 0.0;
    glm::dvec3 mean(0.0);
    for (int i = 0; i < kHeights; ++i)
        for (int j = 0; j < kTurns; ++j) {
            const double root = (i + 0.5) / kHeights;
            const glm::dvec3 wi = direction(root * root, kPi * (j + 0.5) / kTurns);
            const double part = sheen_value(o, wi, alpha) * wi.z * 2.0 * root / kHeights * 2.0 * kPi / kTurns;
            sum += part, mean += part * glm::dvec3(wi.x, 0.0, wi.z);
        }
    return {sum, mean / sum};
}

TEST(sheen, lobe_is_that_of_the_extension)
{
    for (double roughness : {0.1, 0.3, 0.6, 1.0})
        for (double o : {0.05, 0.3, 0.49, 0.51, 0.9})
            for (double i : {0.02, 0.2, 0.5, 0.8, 1.0})
                for (double turn : {0.1, 1.5, 3.0}) {
                    const glm::dvec3 a = direction(o, 0.0), b = direction(i, turn);
                    const real3 wo = {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
                    const real3 wi = {static_cast<float>(b.x), static_cast<float>(b.y), static_cast<float>(b.z)};
                    const charlie_params p = charlie_params_of(static_cast<float>(roughness * roughness));
                    const double expected = sheen_value(a, b, roughness * roughness);
                    EXPECT_NEAR(static_cast<double>(charlie_eval(p, wo, wi)), expected, 1e-4 * expected + 1e-12)
                        << roughness << ' ' << o << ' ' << i;
                    const real3 n = {0.0f, 0.0f, 1.0f};
                    EXPECT_NEAR(static_cast<double>(charlie_eval_about(p, n, wo, wo.z, wi)), expected, 1e-4 * expected + 1e-12);
                }
}

TEST(sheen, fits_of_albedo_and_mean_direction_are_near_the_integrals)
{
    double worst = 0.0;
    for (double roughness : {0.1, 0.14, 0.2, 0.35, 0.5, 0.75, 1.0})
        for (double cosine : {0.05, 0.08, 0.15, 0.3, 0.5, 0.7, 0.9, 0.999}) {
            const SheenIntegral whole = sheen_integral(cosine, roughness * roughness);
            const double fitted = static_cast<double>(charlie_albedo(static_cast<float>(cosine), static_cast<float>(roughness)));
            worst = std::max(worst, std::abs(fitted - std::min(whole.albedo, 1.0)));
            EXPECT_NEAR(fitted, std::min(whole.albedo, 1.0), 0.009) << roughness << ' ' << cosine;
            if (whole.albedo < 0.05)
                continue;
            const charlie_mean mean = charlie_mean_of(static_cast<float>(cosine), static_cast<float>(roughness));
            EXPECT_NEAR(static_cast<double>(mean.along) * std::sqrt(1.0 - cosine * cosine), whole.mean.x, 0.06)
                << roughness << ' ' << cosine;
            EXPECT_NEAR(static_cast<double>(mean.up), whole.mean.z, 0.06) << roughness << ' ' << cosine;
        }
    std::printf("the fit of albedo is off by %.4f at most\n", worst);
}

ReferenceOptions sheen_run(ReferenceMode mode, std::uint64_t samples)
{
    ReferenceOptions o;
    o.mode = mode, o.samples = samples;
    return o;
}

Material cloth_base()
{
    Material m;
    m.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f), m.metallic = 0.0f, m.roughness = 0.6f;
    return m;
}

Material black_cloth()
{
    Material m = cloth_base();
    m.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f), m.specular = 0.0f;
    return m;
}

Material with_sheen(Material below, float roughness, float share = 1.0f)
{
    below.sheen_color = glm::vec3(share), below.sheen_roughness = roughness;
    return below;
}

FrameDesc cloth_view(float cosine, const char* technique, int samples)
{
    const float sine = std::sqrt(1.0f - cosine * cosine);
    FrameDesc d = desc_of(8, 8, view_from({sine * 0.8f, sine * 0.6f, cosine}, 0.05f));
    d.technique = technique, d.samples = samples;
    return d;
}

glm::vec3 cloth_sky(const glm::vec3& d)
{
    return glm::vec3(1.0f + 0.5f * d.x + 0.3f * d.y + 0.1f * d.z);
}

// Constant light of 1: the layer has its share, the base the rest.
TEST(sheen, of_constant_light_both_renderers_give_back_the_same_known_share)
{
    BN_NEEDS_EMBREE();
    for (const Material& below : {metal(0.3f, 0.0f), cloth_base()})
        for (float roughness : {0.1f, 0.3f, 0.6f, 1.0f})
            for (float cosine : {0.95f, 0.6f, 0.25f})
                for (float share : {1.0f, 0.4f}) {
                    Stage bare(plane_scene(below), 1.0f, 2), stage(plane_scene(with_sheen(below, roughness, share)), 1.0f, 2);
                    const FrameDesc d = cloth_view(cosine, "split_isotropic", 1);
                    const double albedo = static_cast<double>(share * charlie_albedo(cosine, roughness));
                    const double expected = (1.0 - albedo) * mean_of(bare.render(d, best_isa())) + albedo;
                    const double drawn = mean_of(stage.render(d, best_isa()));
                    EXPECT_NEAR(drawn, expected, 1e-4) << roughness << ' ' << cosine;
                    EXPECT_LT(drawn, 1.0 + 2e-3);
                    const Estimate e = estimate(render_reference(stage, d, sheen_run(ReferenceMode::direct, 512)));
                    EXPECT_NEAR(e.mean, drawn, kSheenSigmas * e.deviation + 0.009) << roughness << ' ' << cosine;
                }
}

TEST(sheen, mc_agrees_with_the_reference_under_a_sky)
{
    BN_NEEDS_EMBREE();
    for (float roughness : {0.15f, 0.5f, 1.0f})
        for (float cosine : {0.8f, 0.3f}) {
            Stage stage(plane_scene(with_sheen(cloth_base(), roughness)), 1.0f, 2);
            stage.environment = environment_of(cloth_sky, 64, stage.jobs);
            const FrameDesc d = cloth_view(cosine, "mc", 1024);
            const double drawn = mean_of(stage.render(d, best_isa()));
            for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light}) {
                ReferenceOptions o = sheen_run(ReferenceMode::direct, 1024);
                o.strategy = strategy;
                const Estimate e = estimate(render_reference(stage, d, o));
                EXPECT_NEAR(drawn, e.mean, kSheenSigmas * e.deviation + 2e-3)
                    << roughness << ' ' << cosine << ' ' << static_cast<int>(strategy);
            }
        }
}

// Compares the layer alone, over a black base.
TEST(sheen, one_fetch_is_near_what_its_samples_find)
{
    for (float roughness : {0.1f, 0.3f, 0.6f, 1.0f})
        for (float cosine : {0.99f, 0.7f, 0.2f}) {
            Stage stage(plane_scene(with_sheen(black_cloth(), roughness)), 1.0f, 2);
            stage.environment = environment_of(cloth_sky, 64, stage.jobs);
            const double sampled = mean_of(stage.render(cloth_view(cosine, "mc", 4096), best_isa()));
            for (const char* technique : {"bent_normal", "lobe_line", "major_axis"}) {
                const double fetched = mean_of(stage.render(cloth_view(cosine, technique, 16), best_isa()));
                EXPECT_NEAR(fetched, sampled, 0.06 * sampled + 0.01) << technique << ' ' << roughness << ' ' << cosine;
            }
        }
}

// The normal leans by 19 degrees, towards the eye and away from it.
TEST(sheen, follows_the_normal_map)
{
    for (float roughness : {0.3f, 0.6f})
        for (int lean : {86, 170}) {
            Scene scene = plane_scene(with_sheen(black_cloth(), roughness));
            scene.materials[0].normal_tex = add_texel(scene, glm::ivec3(lean, 128, 249));
            Stage stage(scene, 1.0f, 2), flat(plane_scene(with_sheen(black_cloth(), roughness)), 1.0f, 2);
            for (Stage* each : {&stage, &flat})
                each->environment = environment_of(cloth_sky, 64, each->jobs);
            const double sampled = mean_of(stage.render(cloth_view(0.5f, "mc", 4096), best_isa()));
            EXPECT_NEAR(mean_of(stage.render(cloth_view(0.5f, "bent_normal", 1), best_isa())), sampled, 0.12 * sampled + 0.01)
                << roughness << ' ' << lean;
            const double straight = mean_of(flat.render(cloth_view(0.5f, "mc", 4096), best_isa()));
            EXPECT_GT(std::abs(straight / sampled - 1.0), 0.1) << roughness << ' ' << lean;
        }
}

TEST(sheen, black_is_no_layer_word_for_word)
{
    Stage bare(plane_scene(cloth_base())), none(plane_scene(with_sheen(cloth_base(), 0.3f, 0.0f))),
        full(plane_scene(with_sheen(cloth_base(), 0.3f)));
    for (Stage* stage : {&bare, &none, &full})
        stage->environment = environment_of(cloth_sky, 16, stage->jobs);
    for (const TechniqueInfo& t : techniques()) {
        const FrameDesc d = cloth_view(0.4f, t.name, std::min(t.default_samples, 16));
        EXPECT_EQ(bare.render(d, best_isa()).color.bytes, none.render(d, best_isa()).color.bytes) << t.name;
        EXPECT_NE(bare.render(d, best_isa()).color.bytes, full.render(d, best_isa()).color.bytes) << t.name;
    }
}

TEST(sheen, of_a_lamp_is_the_lobe_s_value_in_both_renderers)
{
    for (float roughness : {0.2f, 0.6f}) {
        Scene scene = plane_scene(with_sheen(black_cloth(), roughness));
        add_lamp(scene, {-1.0f, 0.0f, 1.0f}, 3.0f);
        const Stage stage(scene, 0.0f, 2);
        FrameDesc d = desc_of(4, 4, view_from({1, 0, 0.5}, 0.001f));
        d.technique = "split_isotropic";
        const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness), cosine = std::sqrt(0.5);
        const glm::dvec3 o = glm::normalize(glm::dvec3(1.0, 0.0, 0.5)), i = glm::normalize(glm::dvec3(-1.0, 0.0, 1.0));
        const double expected = sheen_value(o, i, alpha) * cosine * 3.0 / 2.0;
        EXPECT_NEAR(mean_of(stage.render(d, best_isa())), expected, 5e-3 * expected) << roughness;
        if (reference_available()) {
            for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path})
                EXPECT_NEAR(estimate(render_reference(stage, d, sheen_run(mode, 64))).mean, expected, 5e-3 * expected) << roughness;
        }
    }
}

// The coat lies over the fibres, which lie over the base.
TEST(sheen, lies_below_a_clear_coat)
{
    const float cosine = 0.5f;
    Material m = with_sheen(black_cloth(), 0.5f), coated = m;
    coated.clearcoat = 1.0f, coated.clearcoat_roughness = 0.1f;
    Material coat_alone = black_cloth();
    coat_alone.clearcoat = 1.0f, coat_alone.clearcoat_roughness = 0.1f;
    const FrameDesc d = cloth_view(cosine, "split_isotropic", 1);
    const double sheen = mean_of(Stage(plane_scene(m), 1.0f, 2).render(d, best_isa()));
    const double coat = mean_of(Stage(plane_scene(coat_alone), 1.0f, 2).render(d, best_isa()));
    const double weight = 0.04 + 0.96 * std::pow(1.0 - static_cast<double>(cosine), 5.0);
    EXPECT_NEAR(mean_of(Stage(plane_scene(coated), 1.0f, 2).render(d, best_isa())), coat + (1.0 - weight) * sheen, 1e-4);
}

} // namespace
} // namespace burnish::test
