// One surface under uniform light from an environment, from directional lights and from area lights. Its diffuse and specular parts are
// equal for all three, in the tile renderer and in the reference.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/scene/area_light.h"
#include "shading/lang/records.h"
#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr double kTurn = 6.28318530717958648;

Material coated_or_not(float roughness, float metallic, float coat)
{
    Material m = metal(roughness, 0.0f);
    m.metallic = metallic, m.base_color = glm::vec4(0.9f, 0.7f, 0.4f, 1.0f);
    m.clearcoat = coat, m.clearcoat_roughness = 0.6f;
    return m;
}

Material cloth()
{
    Material m = coated_or_not(0.8f, 0.0f, 0.0f);
    m.sheen_color = glm::vec3(0.2f), m.sheen_roughness = 0.4f;
    return m;
}

Material dense_coat()
{
    Material m = coated_or_not(0.7f, 0.0f, 1.0f);
    m.clearcoat_ior = 2.2f;
    return m;
}

Material oxide(float metallic)
{
    Material m = coated_or_not(0.6f, metallic, 0.0f);
    m.iridescence = 1.0f, m.iridescence_ior = 2.0f, m.iridescence_thickness = 60.0f;
    return m;
}

struct Surface {
    const char* name;
    Material material;
    double slack = 2e-3; // of light by two ways
};

const std::vector<Surface>& each_surface()
{
    static const std::vector<Surface> all = {{"plastic", coated_or_not(0.5f, 0.0f, 0.0f)},
                                             {"rough plastic", coated_or_not(0.9f, 0.0f, 0.0f)},
                                             {"half a metal", coated_or_not(0.6f, 0.5f, 0.0f)},
                                             {"coated plastic", coated_or_not(0.7f, 0.0f, 1.0f)},
                                             {"cloth", cloth()},
                                             {"plastic under a dense coat", dense_coat()},
                                             {"metal under oxide", oxide(1.0f), 4e-3},
                                             {"plastic under oxide", oxide(0.0f), 4e-3}};
    return all;
}

constexpr glm::vec3 kEyes[] = {{0.1f, 0.0f, 1.0f}, {1.0f, 0.3f, 0.6f}, {1.0f, 0.2f, 0.25f}};

// Adds radiance 1 from above as directional lights, spread evenly by the golden angle.
void light_by_lamps(Stage& stage, int count)
{
    for (int i = 0; i < count; ++i) {
        const double z = (i + 0.5) / count, r = std::sqrt(1.0 - z * z), a = i * 2.39996322972865332;
        PunctualLight l;
        l.directional = true;
        l.direction = -glm::vec3(r * std::cos(a), r * std::sin(a), z);
        l.radiant = glm::vec3(static_cast<float>(kTurn / count));
        stage.tables.lights.push_back(l);
    }
}

// Adds radiance 1 from above as the five sides of a box that stands on the surface.
void light_by_box(Stage& stage)
{
    constexpr float k = 10.0f;
    const std::vector<std::vector<glm::vec3>> sides = {{{-k, -k, k}, {k, -k, k}, {k, k, k}, {-k, k, k}},
                                                       {{-k, -k, -k}, {k, -k, -k}, {k, -k, k}, {-k, -k, k}},
                                                       {{-k, k, -k}, {k, k, -k}, {k, k, k}, {-k, k, k}},
                                                       {{-k, -k, -k}, {-k, k, -k}, {-k, k, k}, {-k, -k, k}},
                                                       {{k, -k, -k}, {k, k, -k}, {k, k, k}, {k, -k, k}}};
    for (const std::vector<glm::vec3>& points : sides) {
        AreaLight light;
        light.shape = AreaShape::quad, light.points = points, light.two_sided = true, light.radiance = glm::vec3(1.0f);
        stage.tables.area_lights.push_back(*place_area_light(light, glm::mat4(1.0f)));
    }
}

// One plane under radiance 1 from everywhere: by the environment, by lamps, by area lights.
struct Lit {
    Stage around, lamps, box;
    explicit Lit(const Material& material)
        : around(plane_scene(material), 1.0f), lamps(plane_scene(material), 0.0f), box(plane_scene(material), 0.0f)
    {
        light_by_lamps(lamps, 4096);
        light_by_box(box);
        for (Stage* stage : {&around, &lamps, &box})
            stage->dfg = bake_dfg(64, 1024, stage->jobs);
    }
};

TEST(light_kinds, share_light_between_diffuse_and_specular_by_one_rule)
{
    for (const Surface& s : each_surface()) {
        Lit lit(s.material);
        for (const glm::vec3& eye : kEyes) {
            FrameDesc d = desc_of(2, 2, view_from(eye, 0.01f));
            const double sky = mean_of(lit.around.render(d, best_isa())), punctual = mean_of(lit.lamps.render(d, best_isa()));
            const double cosines = mean_of(lit.box.render(d, best_isa()));
            d.area_way = kAreaWay_mc, d.light_samples = 16384;
            const double samples = mean_of(lit.box.render(d, best_isa()));
            std::printf("%-14s n.v %.2f: environment %.5f, lamps %+.2f %%, area lights %+.2f %% by cosines, %+.2f %% by samples\n", s.name,
                        static_cast<double>(glm::normalize(eye).z), sky, 100.0 * (punctual / sky - 1.0), 100.0 * (cosines / sky - 1.0),
                        100.0 * (samples / sky - 1.0));
            EXPECT_NEAR(punctual / sky, 1.0, s.slack) << s.name << ' ' << eye.z;
            EXPECT_NEAR(samples / sky, 1.0, s.slack) << s.name << ' ' << eye.z;
            EXPECT_NEAR(cosines / sky, 1.0, 1e-2) << s.name << ' ' << eye.z;
        }
    }
}

TEST(light_kinds, share_light_by_the_same_rule_in_the_reference)
{
    BN_NEEDS_EMBREE();
    ReferenceOptions o;
    o.samples = 4096;
    for (const Surface& s : each_surface()) {
        Lit lit(s.material);
        for (const glm::vec3& eye : kEyes) {
            const FrameDesc d = desc_of(2, 2, view_from(eye, 0.01f));
            ReferenceOptions few = o;
            few.samples = 64; // lamps have no noise
            const double tile = mean_of(lit.around.render(d, best_isa())), punctual = mean_of(render_reference(lit.lamps, d, few));
            const Estimate sky = estimate(render_reference(lit.around, d, o)), area = estimate(render_reference(lit.box, d, o));
            std::printf("%-14s n.v %.2f: environment %.5f, of the reference %+.2f %%, its lamps %+.2f %%, its area lights %+.2f %%\n",
                        s.name, static_cast<double>(glm::normalize(eye).z), tile, 100.0 * (sky.mean / tile - 1.0),
                        100.0 * (punctual / tile - 1.0), 100.0 * (area.mean / tile - 1.0));
            EXPECT_NEAR(sky.mean, tile, s.slack * tile + 4.5 * sky.deviation) << s.name << ' ' << eye.z;
            EXPECT_NEAR(area.mean, tile, s.slack * tile + 4.5 * area.deviation) << s.name << ' ' << eye.z;
            EXPECT_NEAR(punctual, tile, s.slack * tile) << s.name << ' ' << eye.z;
        }
    }
}

} // namespace
} // namespace burnish::test
