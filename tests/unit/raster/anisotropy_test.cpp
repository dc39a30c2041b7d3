// Anisotropy directions from tangents, a material's rotation or a texture give the same image.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "core/scene/builtin/builtin.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

// Angles from the geometric tangent, radians counter-clockwise: of mesh tangents, the material's rotation and the texture's direction.
struct Written {
    float tangent, rotation, texel;
    bool textured;
};

Scene brushed_quad(const Written& w)
{
    const std::array<glm::vec3, 4> p = {glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 1, 0), glm::vec3(-1, 1, 0)};
    Scene s = scene_of({Triangle{p[0], p[1], p[2]}, Triangle{p[0], p[2], p[3]}}, false);
    for (std::size_t i = 0; i < s.vertices.size(); ++i)
        s.vertices.tx[i] = std::cos(w.tangent), s.vertices.ty[i] = std::sin(w.tangent), s.vertices.tz[i] = 0.0f;
    Material& m = s.materials[0];
    m.roughness = 0.45f, m.anisotropy_strength = 0.9f, m.anisotropy_rotation = w.rotation;
    if (!w.textured)
        return s;
    Image image = make_image(1, 1, 3, PixelType::u8);
    const float direction[2] = {std::cos(w.texel), std::sin(w.texel)};
    for (std::size_t c = 0; c < 2; ++c)
        image.bytes[c] = static_cast<std::byte>(std::lround((0.5f + 0.5f * direction[c]) * 255.0f));
    image.bytes[2] = std::byte{255}; // full strength
    Texture t;
    t.image = 0;
    s.images.push_back(std::move(image));
    s.textures.push_back(t);
    m.anisotropy_tex.texture = 0;
    return s;
}

// Returns the angle that remains after a direction is stored in 8 bits a channel.
float stored(float angle)
{
    const auto byte = [](float x) { return static_cast<float>(std::lround((0.5f + 0.5f * x) * 255.0f)) / 255.0f * 2.0f - 1.0f; };
    return std::atan2(byte(std::sin(angle)), byte(std::cos(angle)));
}

// Keeps the sun in the prefiltered levels, since an extracted light grows with a high power of a thin lobe's width
// (extracted_lights_test.cpp).
Environment sky()
{
    EnvironmentOptions options;
    options.extracted_lights = 0;
    options.cube_size = 64, options.samples = 64, options.use_cache = false;
    Jobs jobs{1};
    return *load_environment("builtin:sky", options, Limits{}, jobs);
}

// Returns the largest difference, relative to a's value.
float difference(const Frame& a, const Frame& b)
{
    float most = 0.0f;
    for (int i = 0; i < a.color.width * a.color.height * 3; ++i)
        most = std::max(most, std::abs(a.color.f32()[i] - b.color.f32()[i]) / std::max(a.color.f32()[i], 1e-3f));
    return most;
}

class brushing : public testing::TestWithParam<const char*> {};

TEST_P(brushing, is_the_same_by_tangents_by_rotation_and_by_texture)
{
    const bool overridden = std::string(GetParam()) == "eta";
    const Environment environment = sky();
    const auto picture = [&](const Written& w) {
        Stage stage(brushed_quad(w));
        stage.environment = environment;
        FrameDesc d;
        d.width = d.height = 16;
        d.view = make_view({0.7f, -0.9f, 1.6f}, {0, 0, 0}, 0.4f, d.width, d.height);
        d.technique = "major_axis_weighted", d.samples = 16, d.background = false;
        d.override_anisotropy = overridden, d.anisotropy = 0.95f;
        return stage.render(d, best_isa());
    };
    float least_turn = 1e30f;
    const Frame straight = picture({0.0f, 0.0f, 0.0f, false});
    for (float wanted : {0.3f, 0.7f, 1.1f, 1.9f, 2.6f, 4.0f, 5.3f}) {
        const float angle = stored(wanted);
        const Frame by_tangents = picture({angle, 0.0f, 0.0f, false});
        EXPECT_LT(difference(by_tangents, picture({0.0f, angle, 0.0f, false})), 1e-3f) << "rotation by " << angle;
        // A lobe of constant shape reads its albedo from a slice; a textured lobe reads the table over all widths.
        EXPECT_LT(difference(by_tangents, picture({0.0f, 0.0f, wanted, true})), 4e-3f) << "texture of " << angle;
        EXPECT_LT(difference(by_tangents, picture({-0.4f, 0.4f, wanted, true})), 4e-3f) << "all three for " << angle;
        least_turn = std::min(least_turn, difference(by_tangents, straight));
    }
    EXPECT_GT(least_turn, 0.02f); // else nothing was compared
}

// A lobe without width shows the environment in the mirror direction, for every technique and anisotropy.
TEST(anisotropy, a_mirror_shows_the_environment_by_every_technique)
{
    Stage stage(brushed_quad({0.3f, 0.4f, 0.0f, false}));
    stage.environment = sky();
    FrameDesc d;
    d.width = d.height = 24, d.background = false, d.roughness = 0.0f, d.override_anisotropy = true, d.anisotropy = 0.8f;
    d.view = make_view({0.7f, -0.9f, 1.6f}, {0, 0, 0}, 0.4f, d.width, d.height);
    d.technique = "split_isotropic";
    const Frame expected = stage.render(d, best_isa());
    for (const TechniqueInfo& t : techniques()) {
        d.technique = t.name, d.samples = t.default_samples;
        EXPECT_LT(difference(expected, stage.render(d, best_isa())), 5e-3f) << t.name;
    }
    d.technique = "split_isotropic", d.roughness = 0.3f;
    EXPECT_GT(difference(expected, stage.render(d, best_isa())), 0.05f); // else every direction looked the same
}

// A slightly anisotropic lobe equals the isotropic lobe, and nothing jumps where lobes become thin.
TEST(anisotropy, nothing_jumps_where_lobes_are_nearly_round_or_thin)
{
    Stage stage(brushed_quad({0.3f, 0.4f, 0.0f, false}));
    stage.environment = sky();
    FrameDesc d;
    d.width = d.height = 16, d.background = false, d.override_anisotropy = true, d.samples = 8;
    d.view = make_view({0.7f, -0.9f, 1.6f}, {0, 0, 0}, 0.4f, d.width, d.height);
    float round = 0.0f, step = 0.0f;
    for (const char* technique : {"split_isotropic", "bent_normal", "major_axis_weighted"}) {
        d.technique = technique;
        Frame before;
        for (float roughness = 0.0003f; roughness < 0.09f; roughness *= 1.06f) {
            d.roughness = roughness, d.anisotropy = 1e-5f;
            Frame thin = stage.render(d, best_isa());
            if (!before.color.empty())
                step = std::max(step, difference(before, thin));
            d.anisotropy = 0.0f;
            round = std::max(round, difference(stage.render(d, best_isa()), thin));
            before = std::move(thin);
        }
    }
    std::printf("round against nearly round %.5f, step of 6 %% of roughness %.5f\n", static_cast<double>(round), static_cast<double>(step));
    EXPECT_LT(round, 0.01f);
    EXPECT_LT(step, 0.1f);
}

// Counts the words from `input` to the end of a pair's record: the rest of material.def and the colour.
constexpr int words_from(std::string_view input)
{
    int sum = 3;
    bool counts = false;
#define BN_INPUT(type, words, name)                                                                                                        \
    counts = counts || input == #name;                                                                                                     \
    sum += counts ? words : 0;
#include "shading/material.def"
    return sum;
}

// A lobe of eta 0.95 is 39 times as wide along its axis as across. Plain halves, with 11 bits, would change its narrow width by a fifth.
TEST(anisotropy, textures_keep_more_bits_than_a_half_has)
{
    for (int i = 0; i < 64; ++i) {
        const float wanted = 0.1f * static_cast<float>(i);
        const Stage stage(brushed_quad({0.0f, 0.0f, wanted, true}));
        FrameDesc d;
        d.width = d.height = 3, d.msaa = 1;
        d.view = make_view({0, 0, 1.6f}, {0, 0, 0}, 0.4f, d.width, d.height);
        d.stages = true;
        const Frame f = stage.render(d, best_isa());
        const float* tensors = reinterpret_cast<const float*>(f.stages.pairs.data() + 4 * kPairWords) + kPairWords -
                               words_from("tensor2"); // of the middle pixel
        const double c = std::cos(static_cast<double>(stored(wanted))), s = std::sin(static_cast<double>(stored(wanted)));
        for (int power : {0, 1}) {
            EXPECT_NEAR(static_cast<double>(tensors[3 * power]), c * c, 2e-6) << wanted;
            EXPECT_NEAR(static_cast<double>(tensors[3 * power + 1]), s * s, 2e-6) << wanted;
            EXPECT_NEAR(static_cast<double>(tensors[3 * power + 2]), c * s, 2e-6) << wanted;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(of, brushing, testing::Values("strength", "eta"), [](const auto& p) { return std::string(p.param); });

} // namespace
} // namespace burnish::test
