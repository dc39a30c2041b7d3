// Clear coats: the tile renderer and the reference against closed forms and each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "shading/surface/dfg.k.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kCoatSigmas = 4.5;

ReferenceOptions run_of(ReferenceMode mode, std::uint64_t samples)
{
    ReferenceOptions o;
    o.mode = mode, o.samples = samples;
    return o;
}

Material coated(Material below, float roughness, float coat = 1.0f)
{
    below.clearcoat = coat, below.clearcoat_roughness = roughness;
    return below;
}

Material coat_base()
{
    Material m;
    m.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    m.metallic = 0.0f, m.roughness = 0.4f;
    return m;
}

Material black_base() // reflects nothing
{
    Material m = coat_base();
    m.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f), m.specular = 0.0f;
    return m;
}

double mean_words(const Frame& f)
{
    const std::size_t count = std::size_t{3} * static_cast<std::size_t>(f.color.width) * static_cast<std::size_t>(f.color.height);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        sum += static_cast<double>(f.color.f32()[i]);
    return sum / static_cast<double>(count);
}

bool same_words(const Frame& a, const Frame& b)
{
    return a.color.bytes == b.color.bytes;
}

// KHR_materials_clearcoat: Schlick's Fresnel factor for index 1.5 at the view's cosine.
double weight_at(double cosine, double coat)
{
    return coat * (0.04 + 0.96 * std::pow(1.0 - cosine, 5.0));
}

glm::vec3 from_cosine(float cosine)
{
    return {std::sqrt(1.0f - cosine * cosine) * 0.8f, std::sqrt(1.0f - cosine * cosine) * 0.6f, cosine};
}

glm::vec3 coat_sky(const glm::vec3& d)
{
    return glm::vec3(1.0f + 0.5f * d.x + 0.3f * d.y + 0.1f * d.z);
}

FrameDesc coat_view(float cosine, const char* technique, int samples)
{
    FrameDesc d = desc_of(8, 8, view_from(from_cosine(cosine), 0.05f));
    d.technique = technique, d.samples = samples;
    return d;
}

// The base gets the light that the coat does not reflect. The coat gets its share times its lobe's albedo.
TEST(coat, of_constant_light_both_renderers_give_back_the_same_known_share)
{
    BN_NEEDS_EMBREE();
    for (const Material& below : {metal(0.3f, 0.0f), coat_base()})
        for (float roughness : {0.0f, 0.02f, 0.1f, 0.3f, 0.6f, 1.0f})
            for (float cosine : {1.0f, 0.6f, 0.25f})
                for (float coat : {1.0f, 0.4f}) {
                    Stage bare(plane_scene(below), 1.0f, 2), stage(plane_scene(coated(below, roughness, coat)), 1.0f, 2);
                    bare.dfg = stage.dfg = bake_dfg(64, 4096, stage.jobs);
                    const FrameDesc d = coat_view(cosine, "split_isotropic", 1);
                    const dfg_value a = dfg_lookup(stage.dfg.pairs.data(), stage.dfg.size, cosine, roughness);
                    const double w = weight_at(static_cast<double>(cosine), static_cast<double>(coat));
                    const double under = mean_words(bare.render(d, best_isa()));
                    const double expected = (1.0 - w) * under + w * static_cast<double>(a.scale + a.bias);
                    const double drawn = mean_words(stage.render(d, best_isa()));
                    EXPECT_NEAR(drawn, expected, 2e-5) << roughness << ' ' << cosine;
                    EXPECT_LT(drawn, 1.0 + 2e-3);
                    for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf}) {
                        ReferenceOptions o = run_of(ReferenceMode::direct, 512);
                        o.strategy = strategy;
                        const Estimate e = estimate(render_reference(stage, d, o));
                        EXPECT_NEAR(e.mean, drawn, kCoatSigmas * e.deviation + 1.5e-3)
                            << roughness << ' ' << cosine << ' ' << static_cast<int>(strategy);
                        EXPECT_LT(e.mean, 1.0 + 2e-3 + kCoatSigmas * e.deviation);
                    }
                }
}

// mc samples the coat as well, above an anisotropic lobe that reflects light from other places.
TEST(coat, mc_agrees_with_the_reference_under_a_sky)
{
    BN_NEEDS_EMBREE();
    for (float roughness : {0.02f, 0.15f, 0.4f, 0.7f, 1.0f})
        for (float cosine : {0.8f, 0.3f}) {
            Stage stage(plane_scene(coated(coat_base(), roughness)), 1.0f, 2);
            stage.environment = environment_of(coat_sky, 64, stage.jobs);
            FrameDesc d = coat_view(cosine, "mc", 1024);
            d.override_anisotropy = true, d.anisotropy = 0.7f;
            const double drawn = mean_words(stage.render(d, best_isa()));
            for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light}) {
                ReferenceOptions o = run_of(ReferenceMode::direct, 1024);
                o.strategy = strategy;
                const Estimate e = estimate(render_reference(stage, d, o));
                if (strategy == ReferenceStrategy::light && roughness < 0.1f)
                    continue; // sampling the light does not find such narrow lobes
                EXPECT_NEAR(drawn, e.mean, kCoatSigmas * e.deviation + 1.5e-3)
                    << roughness << ' ' << cosine << ' ' << static_cast<int>(strategy);
            }
        }
}

// Compares the coat alone, over a black base. One fetch replaces the lobe by a round lobe about the mirror direction, which is inexact for
// rough lobes under light from one side.
TEST(coat, one_fetch_is_near_what_its_samples_find)
{
    for (float roughness : {0.0f, 0.02f, 0.15f, 0.4f, 0.7f, 1.0f})
        for (float cosine : {1.0f, 0.8f, 0.3f}) {
            Stage stage(plane_scene(coated(black_base(), roughness)), 1.0f, 2);
            stage.environment = environment_of(coat_sky, 64, stage.jobs);
            const double sampled = mean_words(stage.render(coat_view(cosine, "mc", 1024), best_isa()));
            const double fetched = mean_words(stage.render(coat_view(cosine, "bent_normal", 1), best_isa()));
            std::printf("roughness %.2f, n.v %.1f: %.5f by samples, %.5f by a fetch\n", static_cast<double>(roughness),
                        static_cast<double>(cosine), sampled, fetched);
            EXPECT_NEAR(fetched, sampled, (roughness <= 0.15f ? 0.003 : 0.4) * sampled);
        }
}

TEST(coat, of_no_share_is_no_coat_word_for_word)
{
    Stage bare(plane_scene(coat_base())), none(plane_scene(coated(coat_base(), 0.3f, 0.0f))), full(plane_scene(coated(coat_base(), 0.3f)));
    for (Stage* stage : {&bare, &none, &full})
        stage->environment = environment_of(coat_sky, 16, stage->jobs);
    for (const TechniqueInfo& t : techniques()) {
        const FrameDesc d = coat_view(0.4f, t.name, std::min(t.default_samples, 16));
        EXPECT_TRUE(same_words(bare.render(d, best_isa()), none.render(d, best_isa()))) << t.name;
        EXPECT_FALSE(same_words(bare.render(d, best_isa()), full.render(d, best_isa()))) << t.name;
    }
    if (reference_available()) {
        const FrameDesc d = coat_view(0.4f, "mc", 1);
        EXPECT_TRUE(same_words(render_reference(bare, d, run_of(ReferenceMode::direct, 16)),
                               render_reference(none, d, run_of(ReferenceMode::direct, 16))));
    }
}

// Seen in the mirror direction at 45 degrees, over a black base: D G / (4 cos) times the weight.
TEST(coat, a_lamp_glints_by_the_coat_s_lobe_in_both_renderers)
{
    for (float roughness : {0.3f, 0.6f}) {
        Scene scene = plane_scene(coated(black_base(), roughness));
        add_lamp(scene, {-1.0f, 0.0f, 1.0f}, 3.0f);
        const Stage stage(scene, 0.0f, 2);
        FrameDesc d = desc_of(4, 4, view_from({1, 0, 1}, 0.001f));
        d.technique = "split_isotropic";
        const double alpha2 = std::pow(static_cast<double>(roughness), 4.0), cosine = std::sqrt(0.5);
        const double d_peak = 1.0 / (3.14159265358979 * alpha2);
        const double visible = 0.5 / (2.0 * cosine * std::sqrt(cosine * cosine * (1.0 - alpha2) + alpha2));
        const double expected = weight_at(cosine, 1.0) * d_peak * visible * cosine * 3.0 / 2.0;
        EXPECT_NEAR(mean_words(stage.render(d, best_isa())), expected, 2e-3 * expected) << roughness;
        if (reference_available()) {
            for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path})
                EXPECT_NEAR(estimate(render_reference(stage, d, run_of(mode, 64))).mean, expected, 2e-3 * expected) << roughness;
        }
    }
}

// The coat lies above the emission.
TEST(coat, dims_what_its_surface_gives_off)
{
    Material glowing = coat_base();
    glowing.emissive = glm::vec3(1.0f);
    const Stage stage(plane_scene(coated(glowing, 0.1f)), 0.0f, 2);
    const FrameDesc d = coat_view(0.5f, "split_isotropic", 1);
    EXPECT_NEAR(mean_words(stage.render(d, best_isa())), 1.0 - weight_at(0.5, 1.0), 1e-4);
    if (reference_available()) {
        EXPECT_NEAR(estimate(render_reference(stage, d, run_of(ReferenceMode::direct, 16))).mean, 1.0 - weight_at(0.5, 1.0), 1e-4);
    }
}

// The frame's lobe options change the base and not the coat. Over a black base no such option changes a bit.
TEST(coat, knows_nothing_of_the_lobes_below)
{
    Scene scene = plane_scene(coated(black_base(), 0.3f));
    add_lamp(scene, {-1.0f, 0.2f, 1.0f}, 3.0f);
    Stage stage(scene);
    stage.environment = environment_of(coat_sky, 16, stage.jobs);
    const FrameDesc plain = coat_view(0.6f, "mc", 16);
    const Frame expected = stage.render(plain, best_isa());
    EXPECT_GT(mean_words(expected), 0.03);
    FrameDesc tilted = plain, beckmann = plain, compensated = plain, brushed = plain;
    tilted.tilt_rad = glm::vec2(0.3f, -0.2f);
    beckmann.brdf = 4;
    compensated.energy_compensation = true;
    brushed.roughness = 0.8f, brushed.override_anisotropy = true, brushed.anisotropy = 0.9f;
    for (const FrameDesc& d : {tilted, beckmann, compensated, brushed})
        EXPECT_TRUE(same_words(expected, stage.render(d, best_isa())));
}

// Constant light of 1 on a coat over black: Schlick's reflectance of its index, in both renderers.
TEST(coat, has_the_reflectance_of_its_index)
{
    for (float ior : {1.0f, 1.33f, 1.8f, 2.4f})
        for (float cosine : {0.95f, 0.4f}) {
            Material m = coated(black_base(), 0.05f);
            m.clearcoat_ior = ior;
            const Stage stage(plane_scene(m), 1.0f, 2);
            const double f0 = std::pow((static_cast<double>(ior) - 1.0) / (static_cast<double>(ior) + 1.0), 2.0);
            const double expected = f0 + (1.0 - f0) * std::pow(1.0 - static_cast<double>(cosine), 5.0);
            EXPECT_NEAR(mean_words(stage.render(coat_view(cosine, "split_isotropic", 1), best_isa())), expected, 5e-3)
                << ior << ' ' << cosine;
            if (reference_available()) {
                EXPECT_NEAR(estimate(render_reference(stage, coat_view(cosine, "mc", 1), run_of(ReferenceMode::direct, 256))).mean,
                            expected, 8e-3)
                    << ior << ' ' << cosine;
            }
        }
}

} // namespace
} // namespace burnish::test
