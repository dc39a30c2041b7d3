// Three sampling strategies for one integral must agree within their error bars, per image and per pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/scene/builtin/builtin.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

glm::vec3 lamps(const glm::vec3& d)
{
    glm::vec3 c(0.2f + 0.1f * d.y, 0.25f, 0.3f - 0.1f * d.x);
    if (glm::dot(d, glm::normalize(glm::vec3(0.5f, 0.6f, 0.6f))) > 0.98f)
        c += glm::vec3(20.0f, 15.0f, 9.0f);
    if (d.y < -0.3f)
        c = glm::vec3(0.0f); // nothing to sample
    return c;
}

struct Agreement {
    double picture = 0.0;   // difference of the means over its standard error
    double worst_share = 0; // part of pixels and channels more than 4 deviations apart
    double mean_square = 0; // mean square of differences over deviations: 1 for correct error bars
};

Agreement compare(const Frame& a, const Frame& b)
{
    Agreement r;
    const Estimate x = estimate(a), y = estimate(b);
    r.picture = std::abs(x.mean - y.mean) / std::sqrt(x.deviation * x.deviation + y.deviation * y.deviation);
    std::size_t n = 0, far = 0;
    for (std::size_t i = 0; i < a.color.bytes.size() / sizeof(float); ++i) {
        const double v = static_cast<double>(a.variance.f32()[i]) + static_cast<double>(b.variance.f32()[i]);
        if (!(v > 1e-12))
            continue;
        const double d = static_cast<double>(a.color.f32()[i]) - static_cast<double>(b.color.f32()[i]);
        ++n;
        far += d * d > 16.0 * v;
        r.mean_square += d * d / v;
    }
    r.worst_share = static_cast<double>(far) / static_cast<double>(n);
    r.mean_square /= static_cast<double>(n);
    return r;
}

void expect_agreement(const Stage& stage, const FrameDesc& desc, ReferenceMode mode, std::uint64_t samples, const char* what)
{
    Frame frames[3];
    const ReferenceStrategy strategies[3] = {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light};
    for (int i = 0; i < 3; ++i) {
        ReferenceOptions o;
        o.mode = mode, o.samples = samples, o.strategy = strategies[i];
        o.bounces = 2;
        FrameDesc d = desc;
        d.seed = static_cast<std::uint32_t>(i + 1); // separate seeds: error bars hold for independent estimates
        frames[i] = render_reference(stage, d, o);
    }
    for (int i = 0; i < 3; ++i) {
        const Agreement a = compare(frames[i], frames[(i + 1) % 3]);
        std::printf("%s, mode %d, %d against %d: picture %.2f sigma, mean square %.3f, beyond 4 sigma %.2g\n", what, static_cast<int>(mode),
                    i, (i + 1) % 3, a.picture, a.mean_square, a.worst_share);
        EXPECT_LT(a.picture, 4.0) << what;
        EXPECT_LT(a.worst_share, 4e-3) << what; // 6e-5 for a normal distribution; few passes and small lamps have longer tails
        EXPECT_LT(a.mean_square, 1.3) << what;
        EXPECT_GT(a.mean_square, 0.8) << what;
    }
    const double mis = estimate(frames[0]).deviation;
    EXPECT_LT(mis, 1.3 * estimate(frames[1]).deviation) << what << ": the combination is worse than one of its parts";
    EXPECT_LT(mis, 1.3 * estimate(frames[2]).deviation) << what;
}

TEST(strategies, agree_on_anisotropic_metal_and_matte_balls)
{
    BN_NEEDS_EMBREE();
    Scene scene = ball_scene(metal(0.55f, 0.6f), false);
    Material glossy;
    glossy.base_color = glm::vec4(0.6f, 0.2f, 0.1f, 1.0f);
    glossy.metallic = 0.0f, glossy.roughness = 0.5f;
    add_scene(scene, ball_scene(glossy, false), {1.3f, -0.4f, 0.8f}, 0.6f);
    add_scene(scene, plane_scene(lambert(0.7f)), {0.0f, 0.0f, -1.2f}, 3.0f);
    Stage stage(scene, 1.0f, 2);
    stage.environment = environment_of(lamps, 64, stage.jobs);
    FrameDesc d = desc_of(40, 40, make_view(glm::vec3(1.0f, 1.5f, 5.0f), glm::vec3(0.2f, 0.0f, 0.0f), 0.6f, 40, 40));
    d.background = false;
    for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path})
        expect_agreement(stage, d, mode, 4096, "balls");
}

TEST(strategies, agree_on_the_textured_plate)
{
    BN_NEEDS_EMBREE();
    Result<Scene> scene = make_builtin_scene("plate");
    ASSERT_TRUE(scene);
    update_world(*scene);
    Stage stage(std::move(*scene), 1.0f, 2);
    stage.environment = environment_of(lamps, 64, stage.jobs);
    FrameDesc d = desc_of(32, 32, auto_frame(stage.tables, 32, 32));
    d.background = false;
    expect_agreement(stage, d, ReferenceMode::direct, 32768, "plate"); // brdf sampling rarely finds the lamp
}

// Without occlusion the tile renderer's technique `mc` estimates this integral, with one shading point a pixel.
TEST(strategies, agree_with_the_tile_renderer_s_mc)
{
    BN_NEEDS_EMBREE();
    Stage stage(plane_scene(metal(0.5f, 0.7f)), 1.0f, 2);
    stage.environment = environment_of(lamps, 64, stage.jobs);
    for (const glm::vec2 tilt : {glm::vec2(0.0f), glm::vec2(0.35f, -0.2f)}) {
        FrameDesc d = desc_of(16, 16, view_from({0.2f, 0.3f, 1.0f}, 0.5f)); // every point of the plane looks alike
        d.roughness = 0.5f, d.anisotropy = 0.7f, d.override_anisotropy = true;
        d.tilt_rad = tilt;
        ReferenceOptions o;
        o.samples = 16384;
        const Estimate reference = estimate(render_reference(stage, d, o));
        o.strategy = ReferenceStrategy::light;
        const Estimate light = estimate(render_reference(stage, d, o));
        EXPECT_NEAR(light.mean, reference.mean, 4.0 * std::hypot(light.deviation, reference.deviation));
        d.technique = "mc";
        d.samples = 16384;
        const Frame tile = stage.render(d, best_isa());
        const double mean = mean_of(tile);
        EXPECT_NEAR(reference.mean, mean, 4.0 * reference.deviation + 1e-3 * mean) << "tilt " << tilt.x << " " << tilt.y;
        std::printf("tilt %.2f %.2f: reference %.5f +- %.5f, mc %.5f\n", static_cast<double>(tilt.x), static_cast<double>(tilt.y),
                    reference.mean, reference.deviation, mean);
    }
}

// A mirror's single direction and a lamp without size see a tilted lobe reduced by masking, in both renderers.
TEST(strategies, agree_with_the_tile_renderer_on_tilted_mirrors_and_under_lights)
{
    BN_NEEDS_EMBREE();
    Scene lit = plane_scene(metal(0.5f, 0.7f));
    Light lamp;
    lamp.intensity = 3.0f;
    lit.lights.push_back(lamp);
    Node node;
    node.light = 0;
    node.local[3] = glm::vec4(-0.7f, 0.2f, 1.5f, 1.0f);
    lit.nodes.push_back(node);
    update_world(lit);
    const Stage stages[] = {Stage(plane_scene(metal(0.0f, 0.0f)), 1.0f, 2), Stage(lit, 0.0f, 2)};
    for (const Stage& stage : stages) {
        const bool mirror = &stage == stages;
        double level = 0.0, least = 1e9;
        for (const glm::vec2 tilt : {glm::vec2(0.0f), glm::vec2(0.1f, 0.2f), glm::vec2(-0.1f, -0.2f), glm::vec2(0.2f, -0.1f)}) {
            FrameDesc d = desc_of(8, 8, view_from({0.8f, 0.1f, 0.6f}, 0.02f));
            d.roughness = mirror ? 0.0f : 0.5f, d.anisotropy = 0.7f, d.override_anisotropy = true;
            d.tilt_rad = tilt;
            d.technique = "mc", d.samples = 64;
            ReferenceOptions o;
            o.samples = 1024;
            const double tile = mean_of(stage.render(d, best_isa()));
            for (const ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::path}) {
                o.mode = mode;
                EXPECT_NEAR(estimate(render_reference(stage, d, o)).mean, tile, 5e-3 * tile)
                    << (mirror ? "mirror" : "lamp") << ", tilt " << tilt.x << " " << tilt.y << ", mode " << static_cast<int>(mode);
            }
            level = tilt == glm::vec2(0.0f) ? tile : level;
            least = std::min(least, tile);
        }
        EXPECT_LT(least, 0.8 * level) << "no tilt dims anything here";
        EXPECT_GT(least, 0.0);
    }
}

} // namespace
} // namespace burnish::test
