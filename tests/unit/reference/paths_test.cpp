// Rays between surfaces: shadows, interreflection, transparency, culling.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

Frame look(const Scene& scene, const FrameDesc& d, ReferenceMode mode, std::uint64_t samples, int bounces = 8, float environment = 1.0f)
{
    const Stage stage(scene, environment, 2);
    ReferenceOptions o;
    o.mode = mode, o.samples = samples, o.bounces = bounces;
    return render_reference(stage, d, o);
}

// Views the origin from the side, so that objects above it are not in the way.
FrameDesc of_the_origin()
{
    return desc_of(8, 8, view_from({1.0f, 0.0f, 0.3f}, 0.01f));
}

TEST(paths, a_ball_above_a_plane_takes_its_form_factor)
{
    BN_NEEDS_EMBREE();
    Scene scene = plane_scene(lambert(0.8f));
    add_scene(scene, ball_scene(lambert(0.0f), false), {0, 0, 1.0f}, 0.5f);
    const Estimate open = estimate(look(scene, of_the_origin(), ReferenceMode::direct, 1024));
    EXPECT_NEAR(open.mean, 0.8, 4.5 * open.deviation + 1e-4);
    for (ReferenceMode mode : {ReferenceMode::shadowed, ReferenceMode::path}) {
        const Estimate shadowed = estimate(look(scene, of_the_origin(), mode, 4096));
        // (r / h)^2 of the cosine-weighted sky; the ball has 64 x 32 faces and is slightly smaller
        EXPECT_NEAR(shadowed.mean, 0.8 * (1.0 - 0.25), 4.5 * shadowed.deviation + 2e-3);
        EXPECT_LT(shadowed.deviation, 2e-3);
    }
}

TEST(paths, a_closed_room_sums_the_geometric_series)
{
    BN_NEEDS_EMBREE();
    Material wall = lambert(0.5f);
    wall.emissive = glm::vec3(1.0f, 0.5f, 2.0f);
    const Scene room = room_scene(wall);
    FrameDesc d = desc_of(16, 16, make_view(glm::vec3(0.1f, 0.2f, 0.3f), glm::vec3(-1.0f, 0.1f, 0.2f), 1.5f, 16, 16));
    for (int bounces : {0, 1, 3, 12}) {
        const Frame f = look(room, d, ReferenceMode::path, 512, bounces, 50.0f); // an environment that must not leak in
        double series = 0.0;
        for (int k = 0; k <= bounces; ++k)
            series += std::pow(0.5, k);
        const double emitted = (1.0 + 0.5 + 2.0) / 3.0;
        const Estimate e = estimate(f);
        // Without a specular part every path carries equal light, so there is no noise.
        EXPECT_NEAR(e.mean, emitted * series, 1e-4 * emitted * series) << bounces;
        EXPECT_LT(e.deviation, 1e-5) << bounces;
    }
}

TEST(paths, a_point_light_follows_its_square_law_and_casts_shadows)
{
    BN_NEEDS_EMBREE();
    Scene scene = plane_scene(lambert(0.7f));
    add_lamp(scene, {0.0f, 0.0f, 1.5f}, 3.0f);
    const double expected = 0.7 / 3.14159265358979 * 3.0 / (1.5 * 1.5);
    for (ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path})
        EXPECT_NEAR(estimate(look(scene, of_the_origin(), mode, 64 * 4, 2, 0.0f)).mean, expected, 1e-3 * expected);
    add_scene(scene, ball_scene(lambert(0.0f), false), {0, 0, 0.8f}, 0.2f);
    EXPECT_NEAR(estimate(look(scene, of_the_origin(), ReferenceMode::direct, 128, 2, 0.0f)).mean, expected, 1e-3 * expected);
    EXPECT_EQ(estimate(look(scene, of_the_origin(), ReferenceMode::shadowed, 128, 2, 0.0f)).mean, 0.0);
    EXPECT_EQ(estimate(look(scene, of_the_origin(), ReferenceMode::path, 128, 2, 0.0f)).mean, 0.0);
}

Material card(float alpha, AlphaMode mode)
{
    Material m;
    m.base_color = glm::vec4(0.25f, 0.25f, 0.25f, alpha);
    m.unlit = true;
    m.alpha_mode = mode;
    return m;
}

TEST(paths, transparency_is_coverage)
{
    BN_NEEDS_EMBREE();
    const FrameDesc d = desc_of(8, 8, view_from({0, 0, 1}, 0.5f));
    EXPECT_NEAR(estimate(look(plane_scene(card(0.4f, AlphaMode::mask)), d, ReferenceMode::direct, 128)).mean, 1.0, 1e-6);
    EXPECT_NEAR(estimate(look(plane_scene(card(0.6f, AlphaMode::mask)), d, ReferenceMode::direct, 128)).mean, 0.25, 1e-6);
    const Estimate blend = estimate(look(plane_scene(card(0.6f, AlphaMode::blend)), d, ReferenceMode::direct, 4096));
    EXPECT_NEAR(blend.mean, 0.6 * 0.25 + 0.4, 4.5 * blend.deviation);
    EXPECT_LT(blend.deviation, 1e-2);
}

TEST(paths, what_lets_light_through_casts_half_a_shadow)
{
    BN_NEEDS_EMBREE();
    Scene scene = plane_scene(lambert(0.8f));
    Material veil = lambert(0.0f);
    veil.alpha_mode = AlphaMode::blend;
    veil.base_color.a = 0.5f;
    add_scene(scene, ball_scene(veil, false), {0, 0, 1.0f}, 0.5f);
    const Estimate e = estimate(look(scene, of_the_origin(), ReferenceMode::shadowed, 4096));
    // A ray that crosses the ball crosses it twice, so a quarter of the light passes.
    EXPECT_NEAR(e.mean, 0.8 * (1.0 - 0.25 * 0.75), 4.5 * e.deviation + 2e-3);
}

TEST(paths, backs_of_single_sided_surfaces_are_culled_for_the_camera_alone)
{
    BN_NEEDS_EMBREE();
    const FrameDesc d = desc_of(8, 8, view_from({0, 0, -1}, 0.5f));
    Material single = card(1.0f, AlphaMode::opaque), both = single;
    both.double_sided = true;
    EXPECT_NEAR(estimate(look(plane_scene(single), d, ReferenceMode::direct, 128)).mean, 1.0, 1e-6);
    EXPECT_NEAR(estimate(look(plane_scene(both), d, ReferenceMode::direct, 128)).mean, 0.25, 1e-6);
    // A single-sided card with its back to the plane below still shades the plane.
    Scene scene = plane_scene(lambert(0.8f));
    add_scene(scene, plane_scene(lambert(0.0f)), {0, 0, 0.001f}, 1.0f);
    FrameDesc under = desc_of(8, 8, view_from({0, 0, 1}, 0.5f));
    under.view.eye = {0, 0, 0.0005f};
    under.view.zfar = 1.0f;
    EXPECT_NEAR(estimate(look(scene, under, ReferenceMode::direct, 128)).mean, 0.8, 1e-2);
    EXPECT_LT(estimate(look(scene, under, ReferenceMode::shadowed, 128)).mean, 1e-2);
}

} // namespace
} // namespace burnish::test
