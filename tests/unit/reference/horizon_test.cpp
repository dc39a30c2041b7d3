// Leaning normal maps: a surface reflects no light from below itself, for each renderer and each kind of light.
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

#include "raster/reference/scene_key.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kLean = 0.75; // sine of the angle between both normals
const double kUp = std::sqrt(1.0 - kLean * kLean);

// Returns a plate whose normal map holds (kLean, 0, kUp) everywhere.
Scene leaning_plate(Material material)
{
    Scene scene = plane_scene(material);
    Image map = make_image(1, 1, 3, PixelType::f32);
    map.f32()[0] = static_cast<float>(0.5 + 0.5 * kLean), map.f32()[1] = 0.5f, map.f32()[2] = static_cast<float>(0.5 + 0.5 * kUp);
    scene.images.push_back(map);
    Texture texture;
    texture.image = 0;
    scene.textures.push_back(texture);
    scene.materials[0].normal_tex.texture = 0;
    return scene;
}

// Lights the scene by `above` from above the plate and its edge texels, and by `below` elsewhere.
Stage halves(Scene scene, float above, float below)
{
    Stage stage(std::move(scene), 1.0f, 2);
    stage.environment = environment_of([&](const glm::vec3& d) { return glm::vec3(d.z > -0.02f ? above : below); }, 128, stage.jobs);
    return stage;
}

FrameDesc seen_from(const glm::vec3& eye)
{
    FrameDesc d = desc_of(8, 8, view_from(eye, 0.1f));
    d.background = false;
    d.technique = "bent_normal";
    return d;
}

// A part (1 + cos) / 2 of the cosine-weighted directions around the map's normal lies above the plate.
TEST(horizon, leaves_a_diffuse_plate_what_lies_above_it)
{
    BN_NEEDS_EMBREE();
    const double above = 0.8 * (1.0 + kUp) / 2.0;
    for (const float below : {0.0f, 1.0f, 4.0f}) {
        const Stage stage = halves(leaning_plate(lambert(0.8f)), 1.0f, below);
        FrameDesc d = seen_from({0.5f, 0.0f, 1.0f});
        for (const ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed, ReferenceMode::path}) {
            ReferenceOptions o;
            o.mode = mode, o.samples = 1024;
            const Estimate e = estimate(render_reference(stage, d, o));
            EXPECT_NEAR(e.mean, above, 4e-3 * above + 4.5 * e.deviation) << below << ", mode " << static_cast<int>(mode);
        }
        const double tile = mean_of(stage.render(d, best_isa()));
        std::printf("below %.0f: closed form %.4f, tile renderer %.4f\n", static_cast<double>(below), above, tile);
        EXPECT_NEAR(tile, above, (0.015 + 0.01 * static_cast<double>(below)) * above) << below; // from the prefiltered irradiance
        d.horizon = 0;
        EXPECT_NEAR(mean_of(stage.render(d, best_isa())), above + static_cast<double>(below) * (0.8 - above), 0.04) << below;
    }
}

// The map's normal leans to +x. Light from one half of the sky varies along the horizon, and the hidden part lies at +x alone.
TEST(horizon, hides_light_on_the_side_to_which_a_normal_leans)
{
    BN_NEEDS_EMBREE();
    for (const float side : {1.0f, -1.0f}) {
        Stage stage(leaning_plate(lambert(0.8f)), 1.0f, 2);
        stage.environment = environment_of([&](const glm::vec3& d) { return glm::vec3(d.x * side > 0.0f ? 1.0f : 0.0f); }, 128, stage.jobs);
        const FrameDesc d = seen_from({0.5f, 0.0f, 1.0f});
        ReferenceOptions o;
        o.samples = 4096;
        const Estimate e = estimate(render_reference(stage, d, o));
        const double tile = mean_of(stage.render(d, best_isa()));
        std::printf("side %+.0f: reference %.4f, tile renderer %.4f\n", static_cast<double>(side), e.mean, tile);
        EXPECT_NEAR(tile, e.mean, 0.015 + 4.5 * e.deviation) << side;
    }
}

// A metal of reflectance 1 under light from below alone is black; without the horizon it is not.
TEST(horizon, leaves_a_metal_nothing_of_what_lies_below_it)
{
    BN_NEEDS_EMBREE();
    const Stage stage = halves(leaning_plate(metal(0.5f, 0.0f)), 0.0f, 1.0f);
    FrameDesc d = seen_from({-1.0f, 0.0f, 0.6f});
    d.roughness = 0.5f;
    ReferenceOptions o;
    o.samples = 1024;
    for (const ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed}) {
        o.mode = mode;
        EXPECT_LT(mean_of(render_reference(stage, d, o)), 0.01);
    }
    d.technique = "mc", d.samples = 1024;
    EXPECT_LT(mean_of(stage.render(d, best_isa())), 0.01);
    d.horizon = 0;
    EXPECT_GT(mean_of(render_reference(stage, d, o)), 0.1);
    EXPECT_GT(mean_of(stage.render(d, best_isa())), 0.1);
}

// Without a normal map the option has no effect: pixels and checkpoint keys stay equal.
TEST(horizon, is_nothing_where_no_normal_is_of_a_map)
{
    const auto both = [](Scene scene) {
        const Stage stage(std::move(scene), 1.0f, 1);
        FrameDesc d = seen_from({-1.0f, 0.0f, 0.6f});
        d.anisotropy = 0.5f, d.override_anisotropy = true, d.technique = "auto";
        EXPECT_NE(d.horizon, 0); // it is the default
        const std::uint64_t on = reference_key(stage.input(), d, {});
        const double light = mean_of(stage.render(d, best_isa()));
        d.horizon = 0;
        return std::pair(on == reference_key(stage.input(), d, {}), light == mean_of(stage.render(d, best_isa())));
    };
    EXPECT_EQ(both(plane_scene(metal(0.5f, 0.5f))), std::pair(true, true));
    EXPECT_EQ(both(leaning_plate(metal(0.5f, 0.5f))), std::pair(false, false));
}

} // namespace
} // namespace burnish::test
