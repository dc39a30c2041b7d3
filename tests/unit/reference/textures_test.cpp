// Textures in the reference: at full detail a pixel is the mean over its points, unlike a filtered texture.
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <gtest/gtest.h>

#include "tests/unit/reference/scenes.h"

namespace burnish::test {
namespace {

constexpr int kChecks = 64;               // along a side of the plane
constexpr int kTexels = 64;               // along a side of a check: few points lie between two checks, where texels are mixed
constexpr int kSmooth = 51, kRough = 204; // of 255

Scene plane_of_roughness(float roughness)
{
    Material m = metal(1.0f, 0.0f);
    m.roughness = roughness;
    return plane_scene(m);
}

// Adds a texture that repeats over the plane.
TextureRef add_texture(Scene& scene, const Image& image)
{
    Texture texture;
    texture.image = static_cast<std::int32_t>(scene.images.size());
    scene.images.push_back(image);
    scene.textures.push_back(texture);
    for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
        scene.vertices.u0[i] = (scene.vertices.px[i] + 1.0f) * (kChecks / 4.0f);
        scene.vertices.v0[i] = (scene.vertices.py[i] + 1.0f) * (kChecks / 4.0f);
    }
    TextureRef ref;
    ref.texture = static_cast<std::int32_t>(scene.textures.size()) - 1;
    return ref;
}

using Colour = std::array<int, 3>;

Image checks_of(const Colour& one, const Colour& other)
{
    Image checks = make_image(2 * kTexels, 2 * kTexels, 3, PixelType::u8);
    for (int y = 0; y < 2 * kTexels; ++y)
        for (int x = 0; x < 2 * kTexels; ++x)
            for (int c = 0; c < 3; ++c)
                checks.bytes[static_cast<std::size_t>(3 * (2 * kTexels * y + x) + c)] =
                    static_cast<std::byte>((x / kTexels == y / kTexels ? one : other)[static_cast<std::size_t>(c)]);
    return checks;
}

Scene checkered_plane()
{
    Scene scene = plane_of_roughness(1.0f);
    scene.materials[0].metallic_roughness_tex =
        add_texture(scene, checks_of({0, kSmooth, 255}, {0, kRough, 255})); // roughness as given, metal
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

// Returns a bright ring at an angle from straight above, where the camera is.
std::function<glm::vec3(const glm::vec3&)> ring(double angle_deg)
{
    const double cosine = std::cos(angle_deg * 3.14159265358979 / 180.0);
    return [cosine](const glm::vec3& d) { return glm::vec3(std::abs(static_cast<double>(d.z) - cosine) < 0.03 ? 10.0f : 0.1f); };
}

struct Means { // of the image, under a ring
    double full, footprint, drawn;
};
Means means_of(const Scene& scene, double angle_deg)
{
    Stage stage(Scene(scene), 1.0f, 2);
    stage.environment = environment_of(ring(angle_deg), 64, stage.jobs);
    FrameDesc d = desc_of(4, 4, view_from({0.0f, 0.0f, 1.0f}, 0.75f));
    d.technique = "mc", d.samples = 4096;
    ReferenceOptions o;
    o.samples = 1024;
    const double footprint = estimate(render_reference(stage, d, o)).mean;
    o.full_textures = true;
    return {estimate(render_reference(stage, d, o)).mean, footprint, mean_of(stage.render(d, best_isa()))};
}

struct Errors { // rms over rings, relative to the reference's mean
    double drawn, footprint;
};
Errors errors_of(const char* name, const Scene& scene, const Scene& reference)
{
    Errors e = {0.0, 0.0};
    double level = 0.0;
    int rings = 0;
    for (double angle = 0.0; angle < 70.0; angle += 10.0, ++rings) {
        const Means m = means_of(scene, angle);
        const double full = means_of(reference, angle).full;
        e.drawn += (m.drawn - full) * (m.drawn - full), e.footprint += (m.footprint - m.drawn) * (m.footprint - m.drawn);
        level += full;
        std::printf("%s: ring at %2.0f degrees: %.4f, footprint %.4f, reference %.4f\n", name, angle, m.drawn, m.footprint, full);
    }
    return {std::sqrt(e.drawn / rings) * rings / level, std::sqrt(e.footprint / rings) * rings / level};
}

TEST(textures, of_tilts_widen_the_lobe_of_what_is_far_away)
{
    BN_NEEDS_EMBREE();
    Scene mapped = plane_of_roughness(0.4f);
    mapped.materials[0].tilt_tex = add_texture(mapped, checks_of({255, 128, 0}, {1, 128, 0}));
    mapped.materials[0].tilt_scale = 0.2f;
    const Errors with = errors_of("tilts", mapped, mapped), without = errors_of("none", plane_of_roughness(0.4f), mapped);
    std::printf("rms with moments %.4f, without %.4f; of the reference by footprints %.4f\n", with.drawn, without.drawn, with.footprint);
    EXPECT_LT(with.drawn, 0.5 * without.drawn);
    EXPECT_LT(with.footprint, 0.02);
}

} // namespace
} // namespace burnish::test
