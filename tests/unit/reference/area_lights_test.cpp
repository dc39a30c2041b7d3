// Area lights in the reference: three estimators that must agree, the tile renderer's transformed cosines beside them, and occluders.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/scene/area_light.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

AreaLight area_light_of(AreaShape shape, const std::vector<glm::vec3>& points, float radius = 0.0f)
{
    AreaLight light;
    light.shape = shape, light.points = points, light.radius = radius;
    light.radiance = glm::vec3(3.0f, 2.0f, 1.0f), light.two_sided = true;
    return light;
}

const std::vector<AreaLight>& each_area_light()
{
    static const std::vector<AreaLight> lights = {
        area_light_of(AreaShape::quad, {{-1.0f, 0.8f, -0.3f}, {1.0f, 0.9f, -0.3f}, {1.0f, 0.9f, 1.0f}, {-1.0f, 0.8f, 1.0f}}),
        area_light_of(AreaShape::polygon, {{0.2f, 0.0f, 0.9f}, {0.1f, 0.5f, 0.9f}, {-0.3f, 0.6f, 0.9f}, {-0.5f, 0.1f, 0.9f}}),
        area_light_of(AreaShape::disk, {{0.3f, -0.3f, 1.0f}, {0.3f, 0.2f, 1.0f}, {0.6f, -0.3f, 1.1f}}),
        area_light_of(AreaShape::sphere, {{-0.4f, -0.2f, 0.6f}}, 0.2f),
        area_light_of(AreaShape::line, {{-0.8f, 0.1f, 0.4f}, {0.7f, 0.3f, 0.9f}}, 0.02f)};
    return lights;
}
const char* const kAreaShapeNames[] = {"quad", "polygon", "disk", "sphere", "line"};

FrameDesc desc_of_lit(const glm::vec3& eye, float roughness, float eta)
{
    FrameDesc d = desc_of(6, 6, view_from(eye, 0.1f));
    d.background = false;
    d.roughness = roughness, d.anisotropy = eta, d.override_anisotropy = true;
    return d;
}

TEST(area_lights, are_found_alike_by_their_points_by_the_lobe_and_by_both)
{
    BN_NEEDS_EMBREE();
    for (std::size_t i = 0; i < each_area_light().size(); ++i)
        for (const ReferenceMode mode : {ReferenceMode::direct, ReferenceMode::shadowed}) {
            const Stage stage(lit_by(plane_scene(metal(0.6f, 0.6f)), {each_area_light()[i]}, true), 0.0f, 2);
            FrameDesc d = desc_of_lit({0.3f, -1.0f, 0.8f}, 0.6f, 0.6f);
            Estimate found[3];
            const ReferenceStrategy strategies[] = {ReferenceStrategy::mis, ReferenceStrategy::brdf, ReferenceStrategy::light};
            for (int k = 0; k < 3; ++k) {
                ReferenceOptions o;
                o.mode = mode, o.samples = 8192, o.strategy = strategies[k];
                d.seed = static_cast<std::uint32_t>(k + 1);
                found[k] = estimate(render_reference(stage, d, o));
            }
            for (int k = 0; k < 3; ++k) {
                const Estimate &a = found[k], &b = found[(k + 1) % 3];
                EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.deviation, b.deviation) + 1e-5)
                    << kAreaShapeNames[i] << ", mode " << static_cast<int>(mode) << ", " << k;
            }
            EXPECT_GT(found[0].mean, 1e-3) << kAreaShapeNames[i];
            EXPECT_LT(found[0].deviation, 1.3 * std::min(found[1].deviation, found[2].deviation)) << kAreaShapeNames[i];
            std::printf("%s mode %d: %.5f %.5f %.5f, deviations %.2g %.2g %.2g\n", kAreaShapeNames[i], static_cast<int>(mode),
                        found[0].mean, found[1].mean, found[2].mean, found[0].deviation, found[1].deviation, found[2].deviation);
        }
}

TEST(area_lights, by_cosines_are_the_reference_s)
{
    BN_NEEDS_EMBREE();
    for (std::size_t i = 0; i < each_area_light().size(); ++i)
        for (const bool shiny : {false, true})
            for (const float roughness : {0.3f, 0.6f}) {
                Material material = metal(roughness, 0.7f);
                material.metallic = shiny ? 1.0f : 0.0f;
                const Stage stage(lit_by(plane_scene(material), {each_area_light()[i]}, false), 0.0f, 2);
                FrameDesc d = desc_of_lit({0.3f, -1.0f, 0.8f}, roughness, 0.7f);
                ReferenceOptions o;
                o.samples = 4096;
                const Estimate reference = estimate(render_reference(stage, d, o));
                d.technique = "bent_normal";
                const Image tile = stage.render(d, best_isa()).color;
                double mean = 0.0;
                for (std::size_t k = 0; k < 6 * 6 * 3; ++k)
                    mean += static_cast<double>(tile.f32()[k]) / (6 * 6 * 3);
                std::printf("%s %s roughness %.1f: reference %.5f +- %.1g, cosines %+.2f %%\n", kAreaShapeNames[i],
                            shiny ? "metal" : "paint", static_cast<double>(roughness), reference.mean, reference.deviation,
                            100.0 * (mean / reference.mean - 1.0));
                EXPECT_NEAR(mean, reference.mean, shiny ? 0.05 * reference.mean + 0.06 : 0.03 * reference.mean)
                    << kAreaShapeNames[i] << ", roughness " << roughness; // relative to a radiance of 2
            }
}

// A wall between light and plate blocks all light. The surface that shows the light occludes no ray.
TEST(area_lights, are_shadowed_by_what_is_in_between)
{
    BN_NEEDS_EMBREE();
    const AreaLight light =
        area_light_of(AreaShape::quad, {{-0.5f, -0.5f, 1.6f}, {-0.5f, 0.5f, 1.6f}, {0.5f, 0.5f, 1.6f}, {0.5f, -0.5f, 1.6f}});
    Scene walled = plane_scene(lambert(0.7f));
    add_scene(walled, plane_scene(lambert(0.0f)), {0.0f, 0.0f, 1.2f}, 5.0f);
    FrameDesc d = desc_of(6, 6, view_from({0.0f, -1.0f, 0.4f}, 0.1f)); // from below the wall
    d.background = false;
    ReferenceOptions o;
    o.samples = 512;
    const auto seen = [&](const Scene& scene, ReferenceMode mode) {
        o.mode = mode;
        return estimate(render_reference(Stage(lit_by(scene, {light}, true), 0.0f, 2), d, o)).mean;
    };
    const double open = seen(plane_scene(lambert(0.7f)), ReferenceMode::direct);
    EXPECT_GT(open, 0.05);
    EXPECT_NEAR(seen(plane_scene(lambert(0.7f)), ReferenceMode::shadowed), open, 2e-3 * open);
    EXPECT_NEAR(seen(walled, ReferenceMode::direct), open, 2e-3 * open);
    EXPECT_EQ(seen(walled, ReferenceMode::shadowed), 0.0);
    EXPECT_EQ(seen(walled, ReferenceMode::path), 0.0); // the wall is black
}

// In a closed room of albedo a with a small light, all bounces together give 1 / (1 - a) times the first one. The light itself counts once.
// A solid light absorbs the paths that hit it.
TEST(area_lights, are_counted_once_along_a_path)
{
    BN_NEEDS_EMBREE();
    const AreaLight light = area_light_of(AreaShape::sphere, {{0.0f, 0.0f, 0.0f}}, 0.5f);
    FrameDesc d = desc_of(8, 8, make_view(glm::vec3(0.0f, 0.0f, 0.9f), glm::vec3(0.3f, 0.2f, 2.0f), 0.3f, 8, 8));
    ReferenceOptions o;
    o.samples = 4096, o.bounces = 60;
    // on a ball around the light the first bounce is even: radiance r^2 / R^2 times albedo
    const auto seen = [&](ReferenceMode mode, bool solid) {
        o.mode = mode;
        AreaLight lamp = light;
        lamp.solid = solid;
        return estimate(render_reference(Stage(lit_by(ball_scene(lambert(0.5f), true), {lamp}, true), 0.0f, 2), d, o)).mean;
    };
    const double once = seen(ReferenceMode::shadowed, false);
    EXPECT_NEAR(once, 2.0 * 0.25 * 0.5, 0.01); // mean radiance 2
    const double passed = seen(ReferenceMode::path, false), ended = seen(ReferenceMode::path, true);
    EXPECT_NEAR(passed, once / (1.0 - 0.5), 0.01 * passed);
    EXPECT_NEAR(ended, once / (1.0 - 0.5 * (1.0 - 0.25)), 0.01 * ended); // a quarter of the light that leaves a wall ends at the lamp
}

} // namespace
} // namespace burnish::test
