// Textures of the reference: at full detail a pixel is the mean of what its points show, whatever a filter would make of the texture.
#include <cmath>
#include <gtest/gtest.h>

#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr int kChecks = 64;               // along a side of the plane
constexpr int kTexels = 64;               // along a side of a check: few points lie between two of them, where texels are mixed
constexpr int kSmooth = 51, kRough = 204; // of 255

Scene plane_of_roughness(float roughness)
{
    Material m = metal(1.0f, 0.0f);
    m.roughness = roughness;
    return plane_scene(m);
}

Scene checkered_plane()
{
    Scene scene = plane_of_roughness(1.0f);
    Image checks = make_image(2 * kTexels, 2 * kTexels, 3, PixelType::u8);
    for (int y = 0; y < 2 * kTexels; ++y)
        for (int x = 0; x < 2 * kTexels; ++x) {
            const int levels[3] = {0, x / kTexels == y / kTexels ? kSmooth : kRough, 255}; // rough as it says, metal
            for (int c = 0; c < 3; ++c)
                checks.bytes[static_cast<std::size_t>(3 * (2 * kTexels * y + x) + c)] = static_cast<std::byte>(levels[c]);
        }
    scene.images.push_back(checks);
    Texture texture;
    texture.image = 0;
    scene.textures.push_back(texture);
    scene.materials[0].metallic_roughness_tex.texture = 0;
    for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
        scene.vertices.u0[i] = (scene.vertices.px[i] + 1.0f) * (kChecks / 4.0f);
        scene.vertices.v0[i] = (scene.vertices.py[i] + 1.0f) * (kChecks / 4.0f);
    }
    return scene;
}

glm::vec3 one_lamp(const glm::vec3& d)
{
    return glm::vec3(d.z > 0.99f ? 50.0f : 0.5f);
}

Estimate seen(Scene scene, bool full_textures)
{
    Stage stage(std::move(scene), 1.0f, 2);
    stage.environment = environment_of(one_lamp, 64, stage.jobs);
    FrameDesc d = desc_of(4, 4, view_from({0.0f, 0.0f, 1.0f}, 0.75f)); // a pixel covers 12 x 12 checks
    ReferenceOptions o;
    o.samples = 4096;
    o.full_textures = full_textures;
    return estimate(render_reference(stage, d, o));
}

TEST(textures, at_full_detail_are_the_mean_of_their_points)
{
    BN_NEEDS_EMBREE();
    const Estimate smooth = seen(plane_of_roughness(kSmooth / 255.0f), false), rough = seen(plane_of_roughness(kRough / 255.0f), false);
    const Estimate full = seen(checkered_plane(), true), filtered = seen(checkered_plane(), false);
    const double mean = (smooth.mean + rough.mean) / 2.0;
    EXPECT_GT(std::abs(filtered.mean - mean), 0.15 * mean) << "the lobe of mean width looks like both: nothing is tested";
    EXPECT_NEAR(full.mean, mean, 0.04 * mean) << filtered.mean; // a thirty-second of the points lies between checks
}

} // namespace
} // namespace burnish::test
