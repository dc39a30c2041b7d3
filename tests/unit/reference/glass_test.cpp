// Transmission: rough interfaces in paths and alone.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/reference/glass.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

ReferenceOptions by(ReferenceMode mode, std::uint64_t samples, int bounces = 8)
{
    ReferenceOptions o;
    o.mode = mode, o.samples = samples, o.bounces = bounces;
    return o;
}

FrameDesc anisotropic(FrameDesc d, float eta)
{
    d.override_anisotropy = true, d.anisotropy = eta;
    return d;
}

// Nothing is absorbed. A ball returns all light except the single-scattering loss, and all light with energy compensation.
TEST(glass, a_ball_in_a_constant_environment_is_not_seen)
{
    BN_NEEDS_EMBREE();
    for (float roughness : {0.0f, 0.05f, 0.3f, 0.7f})
        for (float eta : {0.0f, 0.5f}) {
            const Stage stage(ball_scene(glass(roughness), false), 1.0f, 2);
            FrameDesc d = anisotropic(desc_of(16, 16, view_from({0.3f, 0.2f, 1.0f}, 0.6f)), eta);
            const Estimate loses = estimate(render_reference(stage, d, by(ReferenceMode::path, 256, 100)));
            d.energy_compensation = true;
            const Estimate keeps = estimate(render_reference(stage, d, by(ReferenceMode::path, 256, 100)));
            std::printf("roughness %.2f, eta %.1f: %.5f +- %.5f, compensated %.5f +- %.5f\n", static_cast<double>(roughness),
                        static_cast<double>(eta), loses.mean, loses.deviation, keeps.mean, keeps.deviation);
            EXPECT_NEAR(keeps.mean, 1.0, 4.5 * keeps.deviation + 0.012) << roughness;
            EXPECT_LT(loses.mean, 1.0 + 4.5 * loses.deviation + 1e-4) << roughness;
            if (roughness <= 0.05f) {
                EXPECT_NEAR(loses.mean, 1.0, 4.5 * loses.deviation + 1e-3) << roughness;
            }
        }
}

TEST(glass, passes_what_the_diffuse_part_does_not)
{
    BN_NEEDS_EMBREE();
    for (float transmission : {0.3f, 0.7f}) {
        Scene pane = plane_scene(glass(0.05f, 1.5f, transmission));
        pane.materials[0].double_sided = true;
        const Stage stage(pane, 1.0f, 2);
        for (const glm::vec3& from : {glm::vec3(0.3f, 0.2f, 1.0f), glm::vec3(1.0f, 0.2f, 0.4f), glm::vec3(0.3f, 0.2f, -1.0f)}) {
            const Estimate e = estimate(render_reference(stage, desc_of(8, 8, view_from(from, 0.1f)), by(ReferenceMode::direct, 256)));
            EXPECT_NEAR(e.mean, 1.0, 4.5 * e.deviation + 2e-3) << transmission << ' ' << from.z;
        }
        const FrameDesc d = desc_of(16, 16, view_from({0.3f, 0.2f, 1.0f}, 0.6f));
        Stage tinted(ball_scene(glass(0.0f, 1.0f, transmission), false), 1.0f, 2); // no reflection: half of the light passes, twice
        tinted.scene.materials[0].base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
        const Estimate half = estimate(render_reference(tinted, d, by(ReferenceMode::direct, 256)));
        EXPECT_NEAR(half.mean, 0.5, 4.5 * half.deviation + 2e-3) << transmission;
    }
}

// Returns the radiance through a smooth ball with radius 1, seen along -z at distance b from its centre, in the xz plane.
double seen_through_ball(double b, double ior)
{
    const double in = std::asin(b), out = std::asin(b / ior), r = reflectance(std::cos(in), ior);
    const auto sky = [](double turned) { // angle by which the ray along -z has turned towards -x
        return static_cast<double>(sky_gradient({static_cast<float>(-std::sin(turned)), 0.0f, static_cast<float>(-std::cos(turned))}).x);
    };
    double sum = r * sky(-(kHalfTurn - 2.0 * in)), share = (1.0 - r) * (1.0 - r);
    for (int k = 0; k < 20; ++k, share *= r)
        sum += share * sky(2.0 * (in - out) + k * (kHalfTurn - 2.0 * out));
    return sum;
}

TEST(glass, a_smooth_ball_shows_the_environment_upside_down)
{
    BN_NEEDS_EMBREE();
    Stage stage(ball_scene(glass(0.0f), false), 1.0f, 2);
    stage.environment = environment_of(sky_gradient, 64, stage.jobs);
    const auto seen = [&](float x, float y) {
        FrameDesc d = desc_of(4, 4, view_from({0, 0, 1}, 0.01f));
        d.view.eye += glm::vec3(x, y, 0.0f);
        return estimate(render_reference(stage, d, by(ReferenceMode::path, 1024, 40)));
    };
    for (float b : {-0.85f, -0.6f, -0.3f, 0.3f, 0.6f, 0.85f}) {
        const Estimate e = seen(b, 0.0f);
        EXPECT_NEAR(e.mean, seen_through_ball(static_cast<double>(b), 1.5), 4.5 * e.deviation + 8e-3) << b;
    }
    EXPECT_GT(seen(-0.6f, 0.0f).mean, seen(0.6f, 0.0f).mean + 0.2); // the sky is brighter towards +x and +y
    EXPECT_GT(seen(0.0f, -0.6f).mean, seen(0.0f, 0.6f).mean + 0.1);
}

TEST(glass, of_index_1_is_invisible)
{
    BN_NEEDS_EMBREE();
    for (const Scene& solid : {ball_scene(glass(0.4f, 1.0f), false), room_scene(glass(0.4f, 1.0f))}) {
        Stage stage(solid, 1.0f, 2);
        stage.scene.materials[0].double_sided = true;
        stage.environment = environment_of(sky_gradient, 64, stage.jobs);
        const glm::vec3 from = glm::normalize(glm::vec3(0.3f, 0.4f, 1.0f));
        for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path}) {
            const Estimate e = estimate(render_reference(stage, desc_of(8, 8, view_from(from, 0.3f)), by(mode, 256)));
            EXPECT_NEAR(e.mean, static_cast<double>(sky_gradient(-from).x), 4.5 * e.deviation + 3e-3) << static_cast<int>(mode);
        }
    }
}

// One interface from the front and from behind: tilted, anisotropic, coloured, partly metal.
TEST(glass, mc_shows_what_the_reference_does_through_one_interface)
{
    BN_NEEDS_EMBREE();
    for (float roughness : {0.2f, 0.5f, 0.8f})
        for (float side : {1.0f, -1.0f})
            for (const glm::vec2& tilt : {glm::vec2(0.0f), glm::vec2(0.35f, -0.2f)}) {
                Material m = glass(roughness, 1.5f, 0.7f);
                m.base_color = glm::vec4(0.9f, 0.5f, 0.2f, 1.0f), m.metallic = 0.2f, m.double_sided = true;
                Stage stage(plane_scene(m), 1.0f, 2);
                stage.environment = environment_of(sky_gradient, 64, stage.jobs);
                FrameDesc d = anisotropic(desc_of(8, 8, view_from({0.6f, 0.3f, 0.7f * side}, 0.05f)), 0.5f);
                d.tilt_rad = tilt;
                d.technique = "mc", d.samples = 1024;
                const Estimate drawn = [&] {
                    const Frame f = stage.render(d, best_isa());
                    Estimate e;
                    for (std::size_t i = 0; i < 192; ++i)
                        e.mean += static_cast<double>(f.color.f32()[i]) / 192.0;
                    return e;
                }();
                for (ReferenceStrategy strategy : {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light}) {
                    ReferenceOptions o = by(ReferenceMode::direct, 1024);
                    o.strategy = strategy;
                    const Estimate e = estimate(render_reference(stage, d, o));
                    EXPECT_NEAR(drawn.mean, e.mean, 4.5 * e.deviation + 1.5e-3)
                        << roughness << ' ' << side << ' ' << tilt.x << ' ' << static_cast<int>(strategy);
                    if (strategy != ReferenceStrategy::light) {
                        EXPECT_LT(e.deviation, 2e-3);
                    }
                }
            }
}

// Seen in the mirror direction at 45 degrees: the interface's masking and the exact Fresnel factor, eq. 20.
TEST(glass, a_lamp_glints_by_the_interface_s_lobe)
{
    BN_NEEDS_EMBREE();
    Scene scene = plane_scene(glass(0.6f));
    add_lamp(scene, {-1.0f, 0.0f, 1.0f}, 3.0f);
    const Stage stage(scene, 0.0f, 2);
    FrameDesc d = anisotropic(desc_of(4, 4, view_from({1, 0, 1}, 0.001f)), 0.0f);
    const double alpha2 = 0.36 * 0.36, cosine = std::sqrt(0.5), masked = 2.0 / (1.0 + std::sqrt(1.0 + alpha2));
    const double expected = reflectance(cosine, 1.5) / (kHalfTurn * alpha2) * masked * masked / (4.0 * cosine) * 3.0 / 2.0;
    for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path})
        EXPECT_NEAR(estimate(render_reference(stage, d, by(mode, 64))).mean, expected, 2e-3 * expected) << static_cast<int>(mode);
    d.technique = "mc";
    EXPECT_NEAR(static_cast<double>(stage.render(d, best_isa()).color.f32()[0]), expected, 2e-3 * expected);
}

// At normal incidence: Walter et al. 2007, eq. 21.
TEST(glass, a_lamp_shines_through_where_paths_are_followed)
{
    BN_NEEDS_EMBREE();
    Scene scene = plane_scene(glass(0.6f));
    add_lamp(scene, {0.0f, 0.0f, -1.5f}, 3.0f);
    const Stage stage(scene, 0.0f, 2);
    const FrameDesc d = anisotropic(desc_of(4, 4, view_from({0, 0, 1}, 0.001f)), 0.0f);
    const double alpha = 0.36, jacobian = 1.5 * 1.5 / (0.5 * 0.5);
    const double expected = 0.96 / (kHalfTurn * alpha * alpha) * jacobian * 3.0 / (1.5 * 1.5);
    EXPECT_NEAR(estimate(render_reference(stage, d, by(ReferenceMode::path, 64))).mean, expected, 2e-3 * expected);
    for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed})
        EXPECT_EQ(estimate(render_reference(stage, d, by(mode, 64))).mean, 0.0);
}

} // namespace
} // namespace burnish::test
