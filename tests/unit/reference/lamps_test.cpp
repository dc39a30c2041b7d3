// Several area lights against closed forms: lights occlude nothing unless they are solid, and never themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/scene/area_light.h"
#include "raster/frame/shadow_ratio.h"
#include "raster/reference/scene_key.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kAlbedo = 0.8;
constexpr double kTau = 6.28318530717958648;

AreaLight lamp(AreaShape shape, const std::vector<glm::vec3>& points, float radiance = 1.0f, float radius = 0.0f)
{
    AreaLight light;
    light.shape = shape, light.points = points, light.radius = radius, light.radiance = glm::vec3(radiance);
    return light;
}

AreaLight solid(AreaLight light)
{
    light.solid = true;
    return light;
}

// Returns a square over the origin that shines down or up.
AreaLight square(float z, float half, bool down, float radiance = 1.0f)
{
    const float s = down ? half : -half;
    return lamp(AreaShape::quad, {{-half, -s, z}, {-half, s, z}, {half, s, z}, {half, -s, z}}, radiance);
}

AreaLight ball(float z, float radius, float radiance = 1.0f)
{
    return lamp(AreaShape::sphere, {{0.0f, 0.0f, z}}, radiance, radius);
}

// Returns an upright square beside the z axis. The axis receives light at grazing angles alone.
AreaLight upright(float beside)
{
    return lamp(AreaShape::quad, {{beside, -0.5f, 0.5f}, {beside, -0.5f, 1.5f}, {beside, 0.5f, 1.5f}, {beside, 0.5f, 0.5f}});
}

// Returns the part of a plate's cosine-weighted sky that a light fills, seen from the origin. Uses Lambert's formula for polygons above the
// plate, and (r / h)^2 for a sphere over it.
double form_factor(const AreaLight& light)
{
    const std::vector<glm::vec3>& p = light.points;
    if (light.shape == AreaShape::sphere)
        return std::pow(static_cast<double>(light.radius) / static_cast<double>(p[0].z), 2.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < p.size(); ++k) {
        const glm::dvec3 a = glm::normalize(glm::dvec3(p[k])), b = glm::normalize(glm::dvec3(p[(k + 1) % p.size()]));
        const glm::dvec3 across = glm::cross(a, b);
        sum += std::atan2(glm::length(across), glm::dot(a, b)) * across.z / glm::length(across);
    }
    return std::fabs(sum) / kTau;
}

// Returns the light of a Lambertian plate at the origin, from a side where no light is between plate and camera.
Estimate seen(const std::vector<AreaLight>& lights, float sky, ReferenceMode mode, bool only_lights = false, bool own_rays = false)
{
    FrameDesc d = desc_of(8, 8, view_from({-1.0f, 0.0f, 0.1f}, 1e-4f));
    d.background = false;
    ReferenceOptions o;
    o.mode = mode, o.samples = 2048, o.bounces = 2, o.area_lights_only = only_lights, o.own_rays = own_rays;
    return estimate(render_reference(Stage(lit_by(plane_scene(lambert(static_cast<float>(kAlbedo))), lights, true), sky, 2), d, o));
}

struct Arrangement {
    const char* name;
    std::vector<AreaLight> lights;
    float sky;
    double expected; // over the albedo
};

void expect_light(const Arrangement& a)
{
    for (const auto& [mode, own_rays] :
         {std::pair(ReferenceMode::shadowed, false), {ReferenceMode::path, false}, {ReferenceMode::path, true}}) {
        const Estimate e = seen(a.lights, a.sky, mode, false, own_rays);
        const double expected = kAlbedo * a.expected;
        std::printf("%-40s mode %d: %.6f, expected %.6f (%+.3f %%), deviation %.1g\n", a.name, static_cast<int>(mode), e.mean, expected,
                    expected > 0.0 ? 100.0 * (e.mean / expected - 1.0) : 0.0, e.deviation);
        EXPECT_NEAR(e.mean, expected, 1e-3 * expected) << a.name << ", mode " << static_cast<int>(mode);
        EXPECT_LE(e.deviation, 5e-4 * expected) << a.name;
    }
}

const AreaLight kSquare = square(1.2f, 0.5f, true, 2.0f), kBall = ball(0.7f, 0.2f, 3.0f), kAway = square(0.4f, 0.6f, false, 5.0f);

TEST(lamps, stand_in_nobody_s_way)
{
    BN_NEEDS_EMBREE();
    const double of_square = 2.0 * form_factor(kSquare), of_ball = 3.0 * form_factor(kBall);
    const AreaLight dim = square(0.6f, 0.7f, true, 1e-6f);
    for (const Arrangement& a :
         std::vector<Arrangement>{{"a quad", {kSquare}, 0.0f, of_square},
                                  {"a sphere", {kBall}, 0.0f, of_ball},
                                  {"a quad behind a sphere", {kSquare, kBall}, 0.0f, of_square + of_ball},
                                  {"both behind a quad that faces away", {kAway, kBall, kSquare}, 0.0f, of_square + of_ball},
                                  {"a dim quad under a white sky", {dim}, 1.0f, 1.0},
                                  {"all under a white sky", {kSquare, kAway, kBall}, 1.0f, 1.0 + of_square + of_ball}})
        expect_light(a);
}

TEST(lamps, never_stand_in_their_own_light)
{
    BN_NEEDS_EMBREE();
    for (const float beside : {0.003f, 0.01f, 0.03f, 0.1f})
        for (const bool hard : {false, true}) {
            const AreaLight light = hard ? solid(upright(beside)) : upright(beside);
            expect_light({hard ? "a solid lamp that is grazed" : "a lamp that is grazed", {light}, 0.0f, form_factor(light)});
        }
    for (const AreaLight& light : {solid(kSquare), solid(kBall)})
        expect_light({"a solid lamp", {light}, 0.0f, static_cast<double>(light.radiance.x) * form_factor(light)});
}

TEST(lamps, that_are_solid_stand_in_other_light_s_way)
{
    BN_NEEDS_EMBREE();
    const double part = form_factor(kSquare), of_ball = 3.0 * form_factor(kBall);
    expect_light({"a solid quad under a white sky", {solid(kSquare)}, 1.0f, 1.0 - part + 2.0 * part});
    expect_light({"a sphere before a solid quad", {solid(kSquare), kBall}, 1.0f, 1.0 - part + 2.0 * part + of_ball});
    for (const ReferenceMode mode : {ReferenceMode::shadowed, ReferenceMode::path})
        EXPECT_EQ(seen({solid(square(0.4f, 60.0f, false)), kSquare, kBall}, 0.0f, mode).mean, 0.0);
    EXPECT_GT(seen({solid(square(0.4f, 60.0f, false)), kSquare, kBall}, 0.0f, ReferenceMode::direct).mean, 0.1);
}

// Surfaces near lamps: a wall behind a lamp hides the things behind it, and a wall through a lamp hides none of its light.
TEST(lamps, lie_before_behind_and_in_walls)
{
    BN_NEEDS_EMBREE();
    const auto walled = [](const AreaLight& light, float wall) {
        Scene scene = plane_scene(lambert(static_cast<float>(kAlbedo)));
        add_scene(scene, plane_scene(lambert(0.0f)), {0.0f, 0.0f, wall}, 5.0f);
        FrameDesc d = desc_of(8, 8, view_from({-1.0f, 0.0f, 0.1f}, 1e-4f));
        d.background = false;
        ReferenceOptions o;
        o.mode = ReferenceMode::shadowed, o.samples = 1024;
        return estimate(render_reference(Stage(lit_by(scene, {light}, true), 0.0f, 2), d, o)).mean;
    };
    const double expected = kAlbedo * 2.0 * form_factor(kSquare);
    EXPECT_NEAR(walled(kSquare, 1.2f), expected, 2e-3 * expected);
    EXPECT_NEAR(walled(kSquare, 1.21f), expected, 2e-3 * expected);
    EXPECT_EQ(walled(kSquare, 1.19f), 0.0);
}

// With equal samples shadows remove no bit of unoccluded light, so the ratio to the unshadowed light is 1.
TEST(lamps, without_anything_else_have_no_shadows)
{
    BN_NEEDS_EMBREE();
    const std::vector<AreaLight> lights = {
        kSquare,
        kAway,
        kBall,
        upright(0.004f),
        lamp(AreaShape::polygon, {{0.2f, 0.0f, 0.9f}, {0.1f, 0.5f, 0.9f}, {-0.3f, 0.6f, 0.9f}, {-0.5f, 0.1f, 0.9f}}),
        lamp(AreaShape::disk, {{0.3f, -0.3f, 1.0f}, {0.3f, 0.2f, 1.0f}, {0.6f, -0.3f, 1.1f}}),
        lamp(AreaShape::line, {{-0.8f, 0.1f, 0.6f}, {0.7f, 0.3f, 0.9f}}, 1.0f, 0.02f)};
    for (const bool both_sides : {false, true}) {
        std::vector<AreaLight> sided = lights;
        for (AreaLight& light : sided)
            light.two_sided = both_sides;
        const Stage stage(lit_by(plane_scene(metal(0.5f, 0.4f)), sided, true), 0.0f, 2);
        FrameDesc d = desc_of(8, 8, view_from({-1.0f, 0.0f, 0.3f}, 0.05f));
        d.background = false;
        ReferenceOptions o;
        o.samples = 256, o.area_lights_only = true;
        const Frame open = render_reference(stage, d, o);
        o.mode = ReferenceMode::shadowed;
        const Frame shadowed = render_reference(stage, d, o);
        EXPECT_GT(mean_of(open), 0.1);
        d.layers = true;
        const Image ratio = shadow_ratio(shadowed.color, open.color, stage.render(d, best_isa()).layers, d, stage.jobs);
        for (std::size_t i = 0; i < 8 * 8 * 3; ++i)
            ASSERT_EQ(ratio.f32()[i], 1.0f) << i;
    }
}

// In an emissive room of albedo .5 a path passes the open lamp in its middle. The walls' light is unchanged by the lamp, and each wall
// finds the lamp's light once.
TEST(lamps, let_paths_go_on)
{
    BN_NEEDS_EMBREE();
    AreaLight light = ball(0.0f, 0.5f, 2.0f);
    Material wall = lambert(0.5f);
    wall.emissive = glm::vec3(1.0f);
    const auto in_room = [&](const std::vector<AreaLight>& lights) {
        FrameDesc d = desc_of(8, 8, make_view(glm::vec3(0.0f, 0.0f, 0.9f), glm::vec3(0.3f, 0.2f, 2.0f), 0.3f, 8, 8));
        ReferenceOptions o;
        o.mode = ReferenceMode::path, o.samples = 256, o.bounces = 24;
        return estimate(render_reference(Stage(lit_by(ball_scene(wall, true), lights, true), 0.0f, 2), d, o));
    };
    // On a ball the lamp's first bounce is even: radiance times r^2 / R^2 times albedo. The room has 64 x 32 faces.
    const double open = 2.0 + 2.0 * 0.25 * 0.5 / (1.0 - 0.5), once = 2.0 * 0.25 * 0.5, back = 0.5 * (1.0 - 0.25);
    const Estimate none = in_room({}), some = in_room({light}), hard = in_room({solid(light)});
    std::printf("no lamp %.4f, open lamp %.4f +- %.1g, solid lamp %.4f\n", none.mean, some.mean, some.deviation, hard.mean);
    EXPECT_NEAR(none.mean, 2.0, 1e-3);
    EXPECT_NEAR(some.mean, open, 0.01 * open);
    EXPECT_NEAR(hard.mean, (once + 1.0) / (1.0 - back), 0.01 * open);
}

TEST(lamps, do_not_hide_point_lights)
{
    BN_NEEDS_EMBREE();
    Scene scene = plane_scene(lambert(static_cast<float>(kAlbedo)));
    add_lamp(scene, {0.0f, 0.0f, 1.5f}, 3.0f);
    const auto shadowed = [&](const AreaLight& light) {
        FrameDesc d = desc_of(4, 4, view_from({-1.0f, 0.0f, 0.1f}, 1e-4f));
        ReferenceOptions o;
        o.mode = ReferenceMode::shadowed, o.samples = 64;
        return estimate(render_reference(Stage(lit_by(scene, {light}, true), 0.0f, 2), d, o)).mean;
    };
    const double expected = 2.0 * kAlbedo / kTau * 3.0 / (1.5 * 1.5);
    EXPECT_NEAR(shadowed(kAway), expected, 1e-3 * expected);
    EXPECT_EQ(shadowed(solid(kAway)), 0.0);
}

// Traced modes with area lights have separate checkpoint keys. Checkpoints whose open lights occluded each other are not continued.
TEST(lamps, have_keys_of_their_own_where_rays_are_traced)
{
    const auto key_of = [](const std::vector<AreaLight>& lights, ReferenceMode mode) {
        const Stage stage(lit_by(plane_scene(lambert(0.5f)), lights, true), 0.0f, 1);
        ReferenceOptions o;
        o.mode = mode;
        return reference_key(stage.input(), desc_of(4, 4, view_from({0, 0, 1}, 0.1f)), o);
    };
    const std::uint64_t open = key_of({kSquare}, ReferenceMode::shadowed), hard = key_of({solid(kSquare)}, ReferenceMode::shadowed);
    EXPECT_NE(open, hard);
    EXPECT_NE(open, key_of({kSquare}, ReferenceMode::direct));
}

} // namespace
} // namespace burnish::test
