// Colours with known values: furnaces, punctual lights, textures, alpha.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/scene/builtin/builtin.h"
#include "shading/lang/records.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

Scene quad_scene(float half)
{
    return scene_of({{glm::vec3(-half, -half, 0), glm::vec3(half, -half, 0), glm::vec3(half, half, 0)},
                     {glm::vec3(-half, -half, 0), glm::vec3(half, half, 0), glm::vec3(-half, half, 0)}},
                    false);
}

FrameDesc quad_desc(int side, int msaa)
{
    FrameDesc d;
    d.width = d.height = side, d.msaa = msaa;
    d.view = make_view({0, 0, 4}, {0, 0, 0}, 0.5f, side, side);
    return d;
}

const float* pixel(const Frame& f, int x, int y)
{
    return f.color.f32() + 3 * (y * f.color.width + x);
}

// Under constant radiance 1 a dielectric of albedo 1 reflects exactly 1: light that is not reflected is diffused.
TEST(furnace, white_dielectric_disappears_in_a_constant_environment)
{
    Scene scene = *make_builtin_scene("spheres");
    for (Material& m : scene.materials) {
        m.metallic = 0.0f;
        m.base_color = glm::vec4(1.0f);
    }
    const Stage stage(std::move(scene));
    FrameDesc d;
    d.width = 200, d.height = 140, d.msaa = 4;
    d.view = auto_frame(stage.tables, d.width, d.height);
    const Frame f = stage.render(d, best_isa());
    EXPECT_GT(f.stats.visible_fragments, 5000u);
    for (int i = 0; i < 200 * 140 * 3; ++i)
        ASSERT_NEAR(f.color.f32()[i], 1.0f, 3e-3f) << "pixel " << i / 3;
}

// A metal of reflectance 1 reflects its directional albedo: scale + bias of the DFG table.
TEST(furnace, metal_gives_back_its_directional_albedo)
{
    for (float roughness : {0.0f, 0.3f, 0.7f, 1.0f}) {
        Scene scene = quad_scene(1.0f);
        scene.materials[0].roughness = roughness;
        const Stage stage(std::move(scene));
        const Frame f = stage.render(quad_desc(33, 4), best_isa());
        const int n = stage.dfg.size;
        const float row = roughness * static_cast<float>(n - 1); // n.v = 1 at the centre: the last column
        const std::size_t r0 = static_cast<std::size_t>(std::floor(row)),
                          r1 = std::min<std::size_t>(r0 + 1, static_cast<std::size_t>(n) - 1);
        const auto albedo = [&](std::size_t r) {
            const std::size_t at = r * static_cast<std::size_t>(n) + static_cast<std::size_t>(n) - 1;
            return stage.dfg.pairs[2 * at] + stage.dfg.pairs[2 * at + 1];
        };
        const float expected = albedo(r0) + (row - std::floor(row)) * (albedo(r1) - albedo(r0));
        EXPECT_NEAR(pixel(f, 16, 16)[0], expected, 3e-3f) << roughness;
    }
}

// The analytic fit reproduces the numbers of Pesce and Iwanicki, which differ from the table.
TEST(furnace, the_analytic_fit_of_the_albedo_can_be_chosen)
{
    for (double roughness : {0.3, 0.9}) {
        Scene scene = quad_scene(1.0f);
        scene.materials[0].roughness = static_cast<float>(roughness);
        const Stage stage(std::move(scene));
        FrameDesc d = quad_desc(33, 4);
        d.dfg_fit = true;
        const double a = roughness * roughness, bias = std::exp2(-(7.0 + 4.0 * a));
        const double scale = 1.0 - bias - a * std::max(bias, std::min(roughness, 0.739 + 0.323) - 0.434);
        EXPECT_NEAR(pixel(stage.render(d, best_isa()), 16, 16)[0], scale + bias, 2e-3) << roughness;
        d.dfg_fit = false;
        EXPECT_GT(std::abs(double{pixel(stage.render(d, best_isa()), 16, 16)[0]} - scale - bias), 5e-3) << roughness;
    }
}

// With energy compensation a metal that absorbs nothing reflects all light at any roughness, and disappears.
TEST(furnace, energy_compensation_makes_a_white_metal_disappear)
{
    Scene scene = *make_builtin_scene("spheres");
    for (Material& m : scene.materials)
        m.base_color = glm::vec4(1.0f);
    const Stage stage(std::move(scene));
    FrameDesc d;
    d.width = 160, d.height = 100, d.msaa = 1;
    d.view = auto_frame(stage.tables, d.width, d.height);
    for (float roughness : {0.2f, 0.6f, 1.0f}) {
        d.roughness = roughness, d.energy_compensation = true;
        const Frame with = stage.render(d, best_isa());
        for (int i = 0; i < 160 * 100 * 3; ++i)
            ASSERT_NEAR(with.color.f32()[i], 1.0f, 4e-3f) << "pixel " << i / 3;
        d.energy_compensation = false;
        const Frame without = stage.render(d, best_isa());
        EXPECT_LT(*std::min_element(without.color.f32(), without.color.f32() + 160 * 100 * 3), roughness < 0.5f ? 0.99f : 0.9f);
    }
}

// All techniques agree on two cases: a perfect mirror shows the environment, and a constant environment shows the lobe's albedo.
TEST(technique, a_mirror_is_a_mirror_and_a_constant_environment_gives_the_albedo)
{
    Scene scene = *make_builtin_scene("spheres");
    for (Material& m : scene.materials)
        m.base_color = glm::vec4(1.0f);
    const Stage stage(std::move(scene));
    FrameDesc d;
    d.override_anisotropy = true, d.anisotropy = 0.8f;
    d.width = 160, d.height = 100, d.msaa = 1;
    d.view = auto_frame(stage.tables, d.width, d.height);
    for (const TechniqueInfo& t : techniques()) {
        d.technique = t.name, d.samples = t.default_samples;
        d.roughness = 0.0f;
        const Frame mirror = stage.render(d, best_isa());
        for (int i = 0; i < 160 * 100 * 3; ++i)
            ASSERT_NEAR(mirror.color.f32()[i], 1.0f, 4e-3f) << t.name << " pixel " << i / 3;
        d.roughness = 0.5f;
        const Frame rough = stage.render(d, best_isa());
        const bool sampled_lobe = std::string(t.name).rfind("filtered_is", 0) == 0; // few samples overshoot a little
        for (int i = 0; i < 160 * 100 * 3; ++i)                                     // a lobe never reflects more than it receives
            ASSERT_LT(rough.color.f32()[i], sampled_lobe ? 1.1f : 1.005f) << t.name;
    }
}

// No light arrives from below the surface's horizon, and lobes that face away are invisible. A tilted lobe's remaining light matches Monte
// Carlo of the ellipsoid distribution over whole spheres. (energy_test.cpp tests single views.)
TEST(technique, tilted_lobes_are_dimmed_as_monte_carlo_dims_them)
{
    const Stage stage(*make_builtin_scene("spheres"));
    FrameDesc d;
    d.width = 160, d.height = 100, d.msaa = 1, d.background = false;
    d.view = auto_frame(stage.tables, d.width, d.height);
    d.override_anisotropy = true;
    const auto light = [&](const char* technique, int samples) {
        d.technique = technique, d.samples = samples;
        const Frame f = stage.render(d, best_isa());
        double sum = 0.0;
        for (int i = 0; i < 160 * 100 * 3; ++i)
            sum += static_cast<double>(f.color.f32()[i]);
        return sum;
    };
    for (float roughness : {0.0f, 0.4f, 0.6f})
        for (float anisotropy : {0.0f, 0.7f})
            for (float tilt : {0.3f, 0.6f, 1.0f}) {
                d.roughness = roughness, d.anisotropy = anisotropy, d.tilt_rad = {tilt, 0.0f};
                const double reference = light("mc", 256);
                for (const TechniqueInfo& t : techniques()) {
                    const double ratio = light(t.name, t.default_samples) / reference;
                    const bool beckmann = std::string(t.name) == "filtered_is"; // no tails: all samples may be below the horizon
                    const bool phong = t.traits & kPhongGrid;                   // loses light where rough, upright too
                    EXPECT_GT(ratio, phong      ? 0.7
                                     : beckmann ? 0.85
                                                : 0.97)
                        << t.name << ", roughness " << roughness << ", eta " << anisotropy << ", tilt " << tilt;
                    const bool own = t.sampling == Sampling::grid; // samples with another albedo than the lobe
                    EXPECT_LT(ratio, own ? 1.25 : 1.06)
                        << t.name << ", roughness " << roughness << ", eta " << anisotropy << ", tilt " << tilt;
                }
            }
}

// Every technique on all kinds of lobes, with grazing views, poles and silhouettes, few and many samples, upright and tilted.
TEST(technique, no_lobe_and_no_sample_count_makes_a_nan)
{
    const Stage stage(*make_builtin_scene("spheres"));
    FrameDesc d;
    d.width = 120, d.height = 80, d.msaa = 2;
    d.view = auto_frame(stage.tables, d.width, d.height);
    d.override_anisotropy = true;
    for (const TechniqueInfo& t : techniques())
        for (int samples : {1, 3, 40})
            for (float roughness : {0.0f, 0.02f, 0.5f, 1.0f})
                for (float anisotropy : {-1.0f, 0.0f, 0.3f, 1.0f})
                    for (float tilt : {0.0f, 1.2f}) {
                        d.technique = t.name, d.samples = effective_samples(t, samples);
                        d.roughness = roughness, d.anisotropy = anisotropy, d.tilt_rad = {tilt, -tilt};
                        const Frame f = stage.render(d, best_isa());
                        ASSERT_EQ(count_not_finite(f.color), 0u) << t.name << ", " << samples << " samples, roughness " << roughness
                                                                 << ", eta " << anisotropy << ", tilt " << tilt;
                    }
}

TEST(light, a_point_light_follows_the_inverse_square_and_lambert)
{
    Scene scene = quad_scene(1.0f);
    scene.materials[0].metallic = 0.0f;
    scene.materials[0].roughness = 1.0f;
    scene.materials[0].specular = 0.0f; // no dielectric reflection: Lambert alone
    scene.materials[0].base_color = glm::vec4(0.5f, 0.25f, 1.0f, 1.0f);
    add_lamp(scene, {0, 0, 2}, 8.0f);
    const Stage stage(std::move(scene), 0.0f);
    const Frame f = stage.render(quad_desc(33, 4), best_isa());
    const float expected = 8.0f / 4.0f / 3.14159265f; // intensity / d^2 * albedo / pi
    EXPECT_NEAR(pixel(f, 16, 16)[0], 0.5f * expected, 1e-4f);
    EXPECT_NEAR(pixel(f, 16, 16)[1], 0.25f * expected, 1e-4f);
    EXPECT_NEAR(pixel(f, 16, 16)[2], expected, 1e-4f);
}

// Lights are skipped where no place of a group that is shaded together lies in their range. Here every pixel has different lights, and some
// pixels lie near the end of a range.
TEST(light, of_many_each_shines_as_far_as_its_range)
{
    constexpr int kPlate = 33;
    constexpr double kHalf = 0.6, kHeight = 0.1, kRange = 0.3;
    Scene scene = quad_scene(1.0f);
    scene.materials[0].metallic = 0.0f;
    scene.materials[0].roughness = 1.0f;
    scene.materials[0].specular = 0.0f;
    scene.materials[0].base_color = glm::vec4(1.0f);
    for (int i = 0; i < 40; ++i) // more than a register holds
        add_lamp(scene, glm::vec3(0.17 * (i % 8) - 0.6, 0.25 * (i / 8) - 0.5, kHeight), 0.01f * static_cast<float>(1 + i % 7),
                 static_cast<float>(kRange));
    const Stage stage(scene, 0.0f);
    FrameDesc d = quad_desc(kPlate, 1);
    d.view = make_view({0, 0, 400}, {0, 0, 0}, 2.0f * static_cast<float>(std::atan(kHalf / 400.0)), kPlate, kPlate);
    for (const Isa isa : available_isas()) {
        const Frame f = stage.render(d, isa);
        for (int y = 0; y < kPlate; ++y)
            for (int x = 0; x < kPlate; ++x) {
                const double px = kHalf * (2 * x + 1 - kPlate) / kPlate, py = kHalf * (kPlate - 1 - 2 * y) / kPlate;
                double expected = 0.0;
                for (std::size_t i = 0; i < scene.lights.size(); ++i) {
                    const double dx = scene.nodes[scene.nodes.size() - 40 + i].local[3].x - static_cast<float>(px);
                    const double dy = scene.nodes[scene.nodes.size() - 40 + i].local[3].y - static_cast<float>(py);
                    const double d2 = dx * dx + dy * dy + kHeight * kHeight, share = d2 / (kRange * kRange);
                    const double window = std::max(1.0 - share * share, 0.0);
                    expected += static_cast<double>(scene.lights[i].intensity) * window / d2 * kHeight / std::sqrt(d2) / 3.14159265358979;
                }
                ASSERT_NEAR(pixel(f, x, y)[0], expected, 1e-4 * (1.0 + expected)) << isa_name(isa) << " " << x << " " << y;
            }
    }
}

// A metal quad that faces +z under one directional light, seen from straight above: the lobe's value in closed form.
TEST(light, an_anisotropic_metal_answers_a_light_with_its_anisotropic_lobe)
{
    const double roughness = 0.5, eta = 0.8, slant = 0.35; // of the light, radians
    for (bool along : {true, false}) {
        Scene scene = quad_scene(1.0f);
        scene.materials[0].roughness = static_cast<float>(roughness);
        Light light;
        light.type = LightType::directional;
        light.intensity = 1.0f;
        scene.lights.push_back(light);
        Node node;
        node.light = 0; // shines along its -z: turned about y the light leans along x, about x along y
        const glm::vec3 axis = along ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        node.local = glm::mat4_cast(glm::angleAxis(static_cast<float>(slant), axis));
        scene.nodes.push_back(node);
        update_world(scene);
        const glm::vec3 tangent(scene.vertices.tx[0], scene.vertices.ty[0], scene.vertices.tz[0]);
        const bool light_along_tangent = std::abs(tangent.x) > 0.5f ? along : !along;
        const Stage stage(std::move(scene), 0.0f);
        FrameDesc d = quad_desc(33, 1);
        d.view = make_view({0, 0, 400}, {0, 0, 0}, 0.003f, 33, 33);
        d.technique = "bent_normal", d.override_anisotropy = true, d.anisotropy = static_cast<float>(eta);
        const double pi = 3.14159265358979, a = roughness * roughness;
        const double width = light_along_tangent ? a * (1 + eta) : a * (1 - eta),
                     other = light_along_tangent ? a * (1 - eta) : a * (1 + eta);
        const double hx = std::sin(slant / 2), hz = std::cos(slant / 2), lz = std::cos(slant), lx = std::sin(slant);
        const double q = hx * hx / (width * width) + hz * hz, distribution = 1 / (pi * width * other * q * q);
        const double visibility = 0.5 / (lz + std::sqrt(width * width * lx * lx + lz * lz));
        const double expected = distribution * visibility * lz; // F = 1: a white metal
        EXPECT_NEAR(pixel(stage.render(d, best_isa()), 16, 16)[0], expected, 2e-3 * expected) << along;
        d.technique = "split_isotropic";
        EXPECT_GT(std::abs(double{pixel(stage.render(d, best_isa()), 16, 16)[0]} - expected), 0.1 * expected) << along;
    }
}

Image checker(int side)
{
    Image image = make_image(side, side, 4, PixelType::u8);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 4; ++c)
                image.bytes[static_cast<std::size_t>(4 * (y * side + x) + c)] = static_cast<std::byte>((x + y) % 2 || c == 3 ? 255 : 0);
    return image;
}

Scene textured_floor(float repeats)
{
    Scene scene = quad_scene(1.0f);
    const float u[6] = {0, 1, 1, 0, 1, 0}, v[6] = {1, 1, 0, 1, 0, 0};
    for (std::size_t i = 0; i < 6; ++i)
        scene.vertices.u0[i] = repeats * u[i], scene.vertices.v0[i] = repeats * v[i];
    scene.images.push_back(checker(16));
    Texture t;
    t.image = 0;
    scene.textures.push_back(t);
    scene.materials[0].unlit = true;
    scene.materials[0].base_color_tex.texture = 0;
    scene.primitives[0].has_uv0 = true;
    return scene;
}

// A mirror whose normal map leans by 63 degrees. Seen from the front it mirrors directions below the quad. With the horizon no light
// arrives from there, for any technique. Without the horizon the map applies unchanged.
TEST(material, a_normal_map_with_a_horizon_reflects_nothing_from_below)
{
    Scene scene = textured_floor(1.0f);
    const std::size_t texels = scene.images[0].bytes.size() / 4;
    for (std::size_t i = 0; i < texels; ++i) { // (0.89, 0, 0.45)
        std::byte* t = scene.images[0].bytes.data() + 4 * i;
        t[0] = std::byte{241}, t[1] = std::byte{128}, t[2] = std::byte{185}, t[3] = std::byte{255};
    }
    Material& m = scene.materials[0];
    m.unlit = false, m.base_color_tex.texture = kNone, m.normal_tex.texture = 0;
    m.roughness = 0.1f, m.base_color = glm::vec4(1.0f);
    const Stage stage(std::move(scene));
    FrameDesc d = quad_desc(33, 1);
    for (const TechniqueInfo& t : techniques()) {
        d.technique = t.name, d.samples = t.default_samples;
        d.horizon = false;
        EXPECT_GT(pixel(stage.render(d, best_isa()), 16, 16)[0], 0.5f) << t.name;
        d.horizon = true;
        EXPECT_LT(pixel(stage.render(d, best_isa()), 16, 16)[0], 0.02f) << t.name;
    }
}

// A roughness override leaves a texture's metalness unchanged.
TEST(material, a_roughness_override_keeps_metalness)
{
    Scene scene = textured_floor(1.0f);
    for (std::byte& b : scene.images[0].bytes)
        b = std::byte{0}; // no metal, whatever the factor
    Material& m = scene.materials[0];
    m.unlit = false, m.base_color_tex.texture = kNone, m.metallic_roughness_tex.texture = 0;
    m.metallic = 1.0f, m.specular = 0.0f, m.base_color = glm::vec4(0.5f, 0.25f, 1.0f, 1.0f);
    const Stage stage(std::move(scene));
    FrameDesc d = quad_desc(33, 1);
    d.roughness = 0.4f;
    EXPECT_NEAR(pixel(stage.render(d, best_isa()), 16, 16)[0], 0.5f, 2e-3f); // fully diffuse
}

// From afar the checkerboard must become its mean without moire, in grazing perspective too.
TEST(texture, a_minified_checkerboard_becomes_its_mean)
{
    const Stage stage(textured_floor(40.0f), 0.0f);
    FrameDesc d = quad_desc(64, 1);
    d.view = make_view({0, -1.6f, 0.25f}, {0, 0, 0}, 0.5f, 64, 64);
    const Frame f = stage.render(d, best_isa());
    EXPECT_NEAR(pixel(f, 32, 30)[0], 0.5f, 0.02f);
    const Frame top = stage.render(quad_desc(24, 1), best_isa());
    for (int y = 8; y < 16; ++y)
        for (int x = 8; x < 16; ++x)
            EXPECT_NEAR(pixel(top, x, y)[0], 0.5f, 0.02f);
}

// Texels larger and smaller than pixels side by side, with holes: pixels that are shaded together get the values of pixels shaded alone.
TEST(texture, of_pixels_shaded_together_is_what_each_has_alone)
{
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
        Scene scene = textured_floor(24.0f);
        std::uint32_t noise = 1;
        for (Image& image : scene.images)
            for (std::byte& b : image.bytes)
                b = static_cast<std::byte>((noise = noise * 1664525u + 1013904223u) >> 24);
        scene.materials[0].alpha_mode = mode;
        const Stage stage(std::move(scene), 0.0f);
        for (const int msaa : {1, 4}) {
            FrameDesc d = quad_desc(64, msaa);
            d.view = make_view({0, -1.6f, 0.25f}, {0, 0, 0}, 0.5f, 64, 64);
            const std::uint64_t alone = pixel_hash(stage.render(d, Isa::scalar).color);
            for (const Isa isa : available_isas())
                EXPECT_EQ(pixel_hash(stage.render(d, isa).color), alone) << static_cast<int>(mode) << " " << msaa << " " << isa_name(isa);
        }
    }
}

TEST(texture, a_magnified_texel_keeps_its_colour_and_place)
{
    Scene scene = textured_floor(8.0f);
    for (std::size_t i = 0; i < 6; ++i)
        scene.vertices.u0[i] /= 64.0f, scene.vertices.v0[i] /= 64.0f; // 2x2 texels over the quad
    const Stage stage(std::move(scene), 0.0f);
    FrameDesc d = quad_desc(64, 1);
    d.view = make_view({0, 0, 4}, {0, 0, 0}, 2.0f * std::atan(0.25f), 64, 64);
    const Frame f = stage.render(d, best_isa());
    // texel (0,0), top left, is black; (1,0) is white; their centres lie at a quarter and three quarters
    EXPECT_NEAR(pixel(f, 16, 16)[0], 0.0f, 0.05f);
    EXPECT_NEAR(pixel(f, 48, 16)[0], 1.0f, 0.05f);
    EXPECT_NEAR(pixel(f, 16, 48)[0], 1.0f, 0.05f);
    EXPECT_NEAR(pixel(f, 48, 48)[0], 0.0f, 0.05f);
}

TEST(alpha, a_mask_cuts_and_a_blend_lets_its_share_through)
{
    Scene scene = quad_scene(1.0f);
    scene.materials[0].unlit = true;
    scene.materials[0].base_color = glm::vec4(1, 1, 1, 0.25f);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(pixel(Stage(scene, 0.0f).render(quad_desc(21, 8), best_isa()), 10, 10)[0], 0.0f);
    scene.materials[0].alpha_cutoff = 0.2f;
    EXPECT_EQ(pixel(Stage(scene, 0.0f).render(quad_desc(21, 8), best_isa()), 10, 10)[0], 1.0f);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    EXPECT_EQ(pixel(Stage(scene, 0.0f).render(quad_desc(21, 8), best_isa()), 10, 10)[0], 0.25f);
}

TEST(resolve, an_edge_pixel_is_the_mean_of_its_samples)
{
    // the edge of a white triangle runs through pixel centres: half of each pixel's samples
    Scene scene = scene_of({{glm::vec3(10.5f, 0, 0), glm::vec3(10.5f, -40, 0), glm::vec3(60, -20, 0)}}, true);
    scene.materials[0].unlit = true;
    const Stage stage(std::move(scene), 0.0f);
    FrameDesc d;
    d.width = 40, d.height = 40, d.msaa = 16;
    d.view = pixel_view(40, 40);
    const Frame f = stage.render(d, best_isa());
    // standard positions with x >= 8/16: 9, 12, 10, 13, 11, 8, 15, 14 of sixteen
    EXPECT_NEAR(pixel(f, 10, 20)[0], 0.5f, 1e-6f);
    EXPECT_EQ(pixel(f, 9, 20)[0], 0.0f);
    EXPECT_EQ(pixel(f, 11, 20)[0], 1.0f);
}

} // namespace
} // namespace burnish::test
