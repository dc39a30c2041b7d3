// KHR_materials_dispersion: each channel is refracted by its own index, in both renderers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kPrismSigmas = 4.5;

Material clear_glass(float roughness, float ior, float dispersion)
{
    Material m;
    m.base_color = glm::vec4(1.0f), m.metallic = 0.0f, m.roughness = roughness;
    m.transmission = 1.0f, m.ior = ior, m.dispersion = dispersion;
    return m;
}

// Brighter by far towards -x, where the ball bends light, equal in all channels.
glm::vec3 prism_sky(const glm::vec3& d)
{
    return glm::vec3(std::exp(-6.0f * (d.x + 1.0f)));
}

Stage ball_of(const Material& glass)
{
    Stage stage(ball_scene(glass, false), 1.0f, 2);
    stage.environment = environment_of(prism_sky, 64, stage.jobs);
    return stage;
}

// Looks at the ball's side, which bends light.
FrameDesc side_view(const char* technique, int samples)
{
    View view = view_from({0.0f, 0.0f, 1.0f}, 0.02f);
    view.eye.x += 0.6f;
    FrameDesc d = desc_of(8, 8, view);
    d.technique = technique, d.samples = samples;
    return d;
}

constexpr float kPrismIor = 1.6f, kPrismDispersion = 4.0f; // five times flint glass
constexpr float kHalfSpread = (kPrismIor - 1.0f) * 0.025f * kPrismDispersion;

TEST(dispersion, each_channel_is_the_picture_of_its_index)
{
    for (float roughness : {0.0f, 0.3f})
        for (const char* technique : {"lobe_line", "split_isotropic", "mc"}) {
            const FrameDesc d = side_view(technique, 64);
            const glm::dvec3 drawn = colour_of(ball_of(clear_glass(roughness, kPrismIor, kPrismDispersion)).render(d, best_isa()));
            glm::dvec3 own;
            for (int c = 0; c < 3; ++c)
                own[c] = colour_of(
                    ball_of(clear_glass(roughness, kPrismIor + kHalfSpread * static_cast<float>(c - 1), 0.0f)).render(d, best_isa()))[c];
            std::printf("%-16s roughness %.1f: %.4f %.4f %.4f, of their indices %.4f %.4f %.4f\n", technique,
                        static_cast<double>(roughness), drawn.x, drawn.y, drawn.z, own.x, own.y, own.z);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(drawn[c], own[c], 0.02 * own[c]) << technique << ' ' << c; // reflections have the middle index
            EXPECT_GT(std::abs(drawn.x / drawn.z - 1.0), 0.08) << "nothing is tested: " << technique;
        }
}

TEST(dispersion, mc_and_the_reference_agree_on_one_interface)
{
    BN_NEEDS_EMBREE();
    for (float roughness : {0.15f, 0.5f}) {
        Stage stage(plane_scene(clear_glass(roughness, kPrismIor, kPrismDispersion)), 1.0f, 2);
        stage.environment = environment_of(prism_sky, 64, stage.jobs);
        FrameDesc d = desc_of(8, 8, view_from({0.8f, 0.1f, 0.6f}, 0.02f));
        d.technique = "mc", d.samples = 1024;
        const glm::dvec3 drawn = colour_of(stage.render(d, best_isa()));
        for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf}) {
            ReferenceOptions o;
            o.samples = 1024, o.strategy = strategy;
            const ChannelEstimate e = estimate_channels(render_reference(stage, d, o));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(drawn[c], e.mean[c], kPrismSigmas * e.deviation[c] + 4e-3) << roughness << ' ' << c;
        }
        EXPECT_GT(std::abs(drawn.x / drawn.z - 1.0), 0.03) << "nothing is tested";
    }
}

// A path chooses one channel, and weighs it by 3.
TEST(dispersion, paths_keep_all_light_and_split_it)
{
    BN_NEEDS_EMBREE();
    ReferenceOptions o;
    o.mode = ReferenceMode::path, o.samples = 1024, o.bounces = 32;
    const FrameDesc d = side_view("mc", 64);
    const Stage furnace(ball_scene(clear_glass(0.0f, kPrismIor, kPrismDispersion), false), 1.0f, 2);
    const ChannelEstimate all = estimate_channels(render_reference(furnace, d, o));
    const Stage stage = ball_of(clear_glass(0.0f, kPrismIor, kPrismDispersion));
    const ChannelEstimate split = estimate_channels(render_reference(stage, d, o));
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(all.mean[c], 1.0, kPrismSigmas * all.deviation[c] + 2e-3) << c;
        const float own = kPrismIor + kHalfSpread * static_cast<float>(c - 1);
        const ChannelEstimate alone = estimate_channels(render_reference(ball_of(clear_glass(0.0f, own, 0.0f)), d, o));
        EXPECT_NEAR(split.mean[c], alone.mean[c], kPrismSigmas * std::hypot(split.deviation[c], alone.deviation[c]) + 0.01 * alone.mean[c])
            << c;
    }
    EXPECT_GT(std::abs(split.mean.x / split.mean.z - 1.0), 0.08) << "nothing is tested";
}

// Draws two kinds of glass in one frame as if each were alone: lanes mix them.
TEST(dispersion, beside_plain_glass_leaves_it_alone)
{
    BN_NEEDS_EMBREE();
    const Material glass = clear_glass(0.2f, kPrismIor, 0.0f), prism = clear_glass(0.2f, kPrismIor, kPrismDispersion);
    Scene both = plane_scene(prism);
    add_scene(both, plane_scene(glass), {2.0f, 0.0f, 0.0f}, 1.0f);
    const auto colour = [](Scene scene, float x) {
        Stage stage(std::move(scene), 1.0f, 2);
        stage.environment = environment_of(prism_sky, 64, stage.jobs);
        FrameDesc d = desc_of(16, 16, view_from({0.5f, 0.0f, 0.8f}, 0.01f));
        d.view.eye.x += x;
        ReferenceOptions o;
        o.samples = 1024;
        return estimate_channels(render_reference(stage, d, o));
    };
    const ChannelEstimate mixed = colour(both, 1.0f), plain = colour(plane_scene(glass), 0.0f), split = colour(plane_scene(prism), 0.0f);
    for (int c = 0; c < 3; ++c) {
        const double half = 0.5 * (plain.mean[c] + split.mean[c]);
        EXPECT_NEAR(mixed.mean[c], half, kPrismSigmas * (mixed.deviation[c] + plain.deviation[c] + split.deviation[c]) + 0.02 * half) << c;
    }
    EXPECT_GT(std::abs(split.mean.x / plain.mean.x - 1.0), 0.03) << "nothing is tested";
}

TEST(dispersion, under_a_film_keeps_all_light)
{
    BN_NEEDS_EMBREE();
    Material glass = clear_glass(0.0f, kPrismIor, 10.0f);
    glass.iridescence = 1.0f, glass.iridescence_thickness = 380.0f;
    const Stage furnace(ball_scene(glass, false), 1.0f, 2);
    ReferenceOptions o;
    o.mode = ReferenceMode::path, o.samples = 2048, o.bounces = 64;
    const ChannelEstimate all = estimate_channels(render_reference(furnace, side_view("mc", 64), o));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(all.mean[c], 1.0, kPrismSigmas * all.deviation[c] + 5e-3) << c;
}

TEST(dispersion, of_0_and_of_what_is_opaque_is_none_word_for_word)
{
    Material opaque = clear_glass(0.3f, kPrismIor, kPrismDispersion), bare = clear_glass(0.3f, kPrismIor, 0.0f);
    opaque.transmission = bare.transmission = 0.0f;
    const Stage with = ball_of(opaque), without = ball_of(bare);
    for (const char* technique : {"lobe_line", "mc", "as_mc"}) {
        const FrameDesc d = side_view(technique, 16);
        EXPECT_EQ(with.render(d, best_isa()).color.bytes, without.render(d, best_isa()).color.bytes) << technique; // nothing refracts
    }
    Material tiny = clear_glass(0.3f, kPrismIor, 1e-30f); // refracts three times by one index
    const Stage three = ball_of(tiny), one = ball_of(clear_glass(0.3f, kPrismIor, 0.0f));
    const FrameDesc d = side_view("lobe_line", 16);
    EXPECT_EQ(three.render(d, best_isa()).color.bytes, one.render(d, best_isa()).color.bytes);
}

} // namespace
} // namespace burnish::test
