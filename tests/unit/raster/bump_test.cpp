// A normal map on a grain that a map turns in the surface's plane. The grain turns first, then grain and normal tilt together (n' = (.48,
// -.6, .64), derived by hand).
#include <gtest/gtest.h>

#include <cmath>

#include "raster/frame/frame_record.h"
#include "shading/surface/make_shaded_point.t.h"
#include "tests/unit/raster/fixture.h"

namespace burnish::test {
namespace {

constexpr float kNormal[3] = {0.48f, -0.6f, 0.64f};
constexpr float kTangent[3] = {0.85951220f, 0.17560976f, -0.48f}, kBitangent[3] = {0.17560976f, 0.78048780f, 0.6f};

Scene bumped()
{
    Scene s = scene_of({Triangle{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}}, true);
    Texture t;
    t.image = 0;
    s.images.push_back(make_image(1, 1, 3, PixelType::u8));
    s.textures.push_back(t);
    s.materials[0].normal_tex.texture = 0;
    s.materials[0].metallic = 1.0f, s.materials[0].roughness = 0.5f, s.materials[0].anisotropy_strength = 0.6f;
    return s;
}

// grain: unit vector along the mesh's tangent and bitangent.
aniso_lobe lobe_of(int frame_map, const real2& grain)
{
    const Stage stage(bumped());
    FrameDesc desc;
    desc.width = desc.height = 8;
    desc.view = make_view({0, 0, 2}, {0, 0, 0}, 0.4f, 8, 8);
    desc.frame_map = frame_map;
    FrameMaker maker(stage.input());
    const ShadingFrame f = maker.make(desc);
    visible_point p = {};
    p.normal = {0, 0, 1}, p.tangent = {1, 0, 0}, p.tangent_sign = 1.0f, p.front = true, p.ray = {0, 0, -1};
    material_inputs at = fetch_material(f, f.materials[0], p);
    at.normal_map = {kNormal[0], kNormal[1], kNormal[2]};
    lobe_shape shape = lobe_shape_of(f, f.materials[0], at);
    shape.u = grain;
    shaded_point x = {};
    make_shaded_point(f, f.materials[0], at, shape, p, 0, x);
    return x.lobe;
}

double apart(const real3& a, const glm::vec3& b)
{
    return static_cast<double>(glm::length(glm::vec3(a.x, a.y, a.z) - b));
}

TEST(bump, turns_what_a_rotation_has_turned)
{
    const glm::vec3 n(kNormal[0], kNormal[1], kNormal[2]), projected = glm::normalize(glm::vec3(1, 0, 0) - n * n.x);
    const glm::vec3 frames[2][2] = {{projected, glm::cross(n, projected)},
                                    {{kTangent[0], kTangent[1], kTangent[2]}, {kBitangent[0], kBitangent[1], kBitangent[2]}}};
    for (const glm::vec2& grain : {glm::vec2(1, 0), glm::vec2(0.8f, 0.6f), glm::vec2(-0.28f, 0.96f)})
        for (int way = 0; way < 2; ++way) {
            const aniso_lobe lobe = lobe_of(way == 0 ? kFrameGramSchmidt : kFrameQuaternion, {grain.x, grain.y});
            EXPECT_LT(apart(lobe.u_axis, frames[way][0] * grain.x + frames[way][1] * grain.y), 1e-6) << way << ": " << grain.x;
            EXPECT_LT(apart(lobe.v_axis, frames[way][1] * grain.x - frames[way][0] * grain.y), 1e-6) << way << ": " << grain.x;
        }
}

} // namespace
} // namespace burnish::test
