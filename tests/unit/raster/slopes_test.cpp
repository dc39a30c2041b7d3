// Slope moments: the lobe that shading makes from a tilt texel, from a texel mean, and from roughness maps.
#include <gtest/gtest.h>

#include <cmath>

#include "raster/frame/frame_record.h"
#include "shading/surface/lobe_shape.t.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr float kScale = 0.3f; // of slopes, so that texels hold +kScale or -kScale

int add_texture(Scene& s, Image image)
{
    Texture t;
    t.image = static_cast<std::int32_t>(s.images.size());
    s.images.push_back(std::move(image));
    s.textures.push_back(t);
    return static_cast<int>(s.textures.size()) - 1;
}

Image row_of(const std::vector<std::array<int, 3>>& texels)
{
    Image image = make_image(static_cast<int>(texels.size()), 1, 3, PixelType::u8);
    for (std::size_t i = 0; i < 3 * texels.size(); ++i)
        image.bytes[i] = static_cast<std::byte>(texels[i / 3][i % 3]);
    return image;
}

struct Maps {
    bool roughness = false, direction = false;
};

// Returns a quad whose texels lean to both sides of an axis.
Scene leaning_quad(int axis, const Maps& maps)
{
    const std::array<glm::vec3, 4> p = {glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 1, 0), glm::vec3(-1, 1, 0)};
    Scene s = scene_of({Triangle{p[0], p[1], p[2]}, Triangle{p[0], p[2], p[3]}}, false);
    Material& m = s.materials[0];
    m.roughness = 0.4f, m.metallic = 1.0f, m.tilt_scale = kScale;
    const std::array<int, 3> up = axis == 0 ? std::array{255, 128, 7} : std::array{128, 255, 7};
    const std::array<int, 3> down = axis == 0 ? std::array{1, 128, 7} : std::array{128, 1, 7};
    m.tilt_tex.texture = add_texture(s, row_of({up, down}));
    if (maps.roughness)
        m.metallic_roughness_tex.texture = add_texture(s, row_of({{0, 255, 255}})); // smaller than the other map
    if (maps.direction)
        m.anisotropy_strength = 0.5f, m.anisotropy_tex.texture = add_texture(s, row_of({{255, 128, 255}, {255, 128, 255}}));
    return s;
}

struct Seen {
    lobe_shape shape;
    real2 slope;
};
Seen seen(const Stage& stage, const FrameDesc& desc, real2 uv, float footprint)
{
    FrameMaker maker(stage.input());
    const ShadingFrame f = maker.make(desc);
    visible_point p = {};
    p.uv0 = uv, p.uv0_dx = {footprint, 0.0f}, p.uv0_dy = {0.0f, footprint};
    const material_inputs at = fetch_material(f, f.materials[0], p);
    return {lobe_shape_of(f, f.materials[0], at), at.slope};
}

FrameDesc small_desc()
{
    FrameDesc d;
    d.width = d.height = 8;
    d.view = make_view({0.3f, -0.4f, 2.0f}, {0, 0, 0}, 0.4f, d.width, d.height);
    d.technique = "mc", d.samples = 64, d.background = false;
    return d;
}

double squared(float x)
{
    return static_cast<double>(x) * static_cast<double>(x);
}

// Two texels of +s and -s have mean 0 and add s^2 along their axis. Each texel alone has mean s and adds nothing.
TEST(slopes, of_opposite_texels_are_a_wider_lobe)
{
    for (const int axis : {0, 1})
        for (const Maps& maps : {Maps{}, Maps{true, false}, Maps{false, true}, Maps{true, true}})
            for (const int override_it : {0, 1, 2}) {
                const Stage stage(leaning_quad(axis, maps));
                FrameDesc desc = small_desc();
                if (override_it == 1)
                    desc.roughness = 0.5f;
                if (override_it == 2)
                    desc.override_anisotropy = true, desc.anisotropy = 0.6f;
                SCOPED_TRACE(testing::Message() << axis << maps.roughness << maps.direction << override_it);
                const Seen alone = seen(stage, desc, {0.25f, 0.5f}, 0.0f), other = seen(stage, desc, {0.75f, 0.5f}, 0.0f);
                EXPECT_NEAR(axis == 0 ? alone.slope.x : alone.slope.y, kScale, 1e-6f);
                EXPECT_NEAR(axis == 0 ? other.slope.x : other.slope.y, -kScale, 1e-6f);
                EXPECT_NEAR(axis == 0 ? alone.slope.y : alone.slope.x, 0.0f, 1e-6f);
                const double alpha = override_it == 1 ? 0.25 : 0.16, across = alpha * alpha / 2.0;
                double widest = across, narrowest = across;
                if (override_it == 2)
                    widest *= 1.6 * 1.6, narrowest *= 0.4 * 0.4;
                else if (maps.direction)
                    widest = std::pow(alpha + (1.0 - alpha) * 0.25, 2.0) / 2.0;
                EXPECT_NEAR(squared(alone.shape.sigma_u), widest, 2e-6 + 1e-3 * widest);
                EXPECT_NEAR(squared(alone.shape.sigma_v), narrowest, 2e-6 + 1e-3 * narrowest);
                const double x = widest + (axis == 0 ? squared(kScale) : 0.0), y = narrowest + (axis == 1 ? squared(kScale) : 0.0);
                for (const float footprint : {0.0f, 1.0f, 20.0f}) { // between both, over both, the last level
                    const Seen both = seen(stage, desc, {0.5f, 0.5f}, footprint);
                    EXPECT_NEAR(both.slope.x, 0.0f, 1e-6f);
                    EXPECT_NEAR(both.slope.y, 0.0f, 1e-6f);
                    EXPECT_NEAR(squared(both.shape.sigma_u), std::max(x, y), 2e-6 + 1e-3 * widest);
                    EXPECT_NEAR(squared(both.shape.sigma_v), std::min(x, y), 2e-6 + 1e-3 * narrowest);
                    EXPECT_GT(std::abs(x > y ? both.shape.u.x : both.shape.u.y), 0.999f);
                }
            }
}

// A map of one slope is a tilt.
TEST(slopes, of_one_value_are_a_tilt)
{
    Scene scene = leaning_quad(0, {});
    Image image = make_image(1, 1, 3, PixelType::f32);
    const glm::vec2 tilt = glm::radians(glm::vec2(15.0f, -10.0f));
    image.f32()[0] = std::tan(tilt.y), image.f32()[1] = -std::tan(tilt.x) / std::cos(tilt.y), image.f32()[2] = 0.0f;
    scene.images[0] = image, scene.materials[0].tilt_scale = 1.0f;
    scene.materials[0].anisotropy_strength = 0.5f; // a round lobe's axes are arbitrary
    Scene plain = scene;
    plain.materials[0].tilt_tex = {};
    const Stage mapped(std::move(scene)), bare(std::move(plain));
    FrameDesc desc = small_desc();
    FrameDesc tilted = desc;
    tilted.tilt_rad = tilt;
    const Frame a = mapped.render(desc, Isa::scalar), b = bare.render(tilted, Isa::scalar), upright = bare.render(desc, Isa::scalar);
    double off = 0.0, changed = 0.0;
    for (int i = 0; i < 8 * 8 * 3; ++i) {
        off = std::max(off, std::abs(static_cast<double>(a.color.f32()[i]) - static_cast<double>(b.color.f32()[i])));
        changed = std::max(changed, std::abs(static_cast<double>(upright.color.f32()[i]) - static_cast<double>(b.color.f32()[i])));
    }
    EXPECT_LT(off, 1e-3);
    EXPECT_GT(changed, 0.05);
}

} // namespace
} // namespace burnish::test
