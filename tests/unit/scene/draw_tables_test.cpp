#include "core/scene/draw_tables.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "core/scene/builtin/builtin.h"
#include "core/scene/builtin/surface.h"

namespace burnish {
namespace {

// Returns a unit sphere with tangents to the east, as mesh 0.
Scene sphere_scene()
{
    Scene scene;
    scene.materials.emplace_back();
    const std::uint32_t first = begin_primitive(scene, 0);
    add_grid(scene, 24, 12, [](int column, int row) {
        const double a = 2.0 * 3.141592653589793 * column / 24, b = 3.141592653589793 * (row / 12.0 - 0.5);
        SurfacePoint s;
        const double c = row % 12 ? std::cos(b) : 0.0; // the poles are points
        s.normal = {c * std::cos(a), std::sin(b), -c * std::sin(a)};
        s.position = s.normal;
        s.tangent = {-std::sin(a), 0.0, -std::cos(a)};
        s.u = column / 24.0;
        s.v = 1.0 - row / 12.0;
        return s;
    });
    add_mesh(scene, "sphere", first);
    return scene;
}

DrawTables placed(const glm::mat4& local)
{
    Scene scene = sphere_scene();
    add_node(scene, "n", 0, local);
    update_world(scene);
    return make_draw_tables(scene);
}

glm::vec3 position(const DrawTables& t, std::uint32_t i)
{
    return {t.px[i], t.py[i], t.pz[i]};
}
glm::vec3 normal(const DrawTables& t, std::uint32_t i)
{
    const float* n = t.shading[i].normal;
    return {n[0], n[1], n[2]};
}
glm::vec3 tangent(const DrawTables& t, std::uint32_t i)
{
    const float* a = t.shading[i].tangent;
    return {a[0], a[1], a[2]};
}
glm::vec3 bitangent(const DrawTables& t, std::uint32_t i)
{
    return t.shading[i].tangent[3] * glm::cross(normal(t, i), tangent(t, i));
}

// Expects orthonormal frames, and faces that agree with their normals and look away from `inside`.
void expect_outward(const DrawTables& t, const glm::vec3& inside)
{
    for (std::size_t k = 0; k < t.triangle_count(); ++k) {
        const std::uint32_t a = t.indices[3 * k], b = t.indices[3 * k + 1], c = t.indices[3 * k + 2];
        const glm::dvec3 pa(position(t, a)), pb(position(t, b)), pc(position(t, c));
        const glm::dvec3 n = glm::cross(pb - pa, pc - pa);
        ASSERT_GT(glm::dot(n, pa - glm::dvec3(inside)), 0.0) << k;
        ASSERT_GT(glm::dot(n, glm::dvec3(normal(t, a) + normal(t, b) + normal(t, c))), 0.0) << k;
    }
    for (std::uint32_t i = 0; i < t.shading.size(); ++i) {
        ASSERT_NEAR(glm::length(normal(t, i)), 1.0f, 1e-6f) << i;
        ASSERT_NEAR(glm::length(tangent(t, i)), 1.0f, 1e-6f) << i;
        ASSERT_NEAR(glm::dot(tangent(t, i), normal(t, i)), 0.0f, 1e-6f) << i;
    }
}

// Expects the tangent along growing u and the bitangent along shrinking v, for any matrix.
void expect_follows_uv(const DrawTables& t)
{
    int checked = 0;
    for (std::size_t k = 0; k < t.triangle_count(); ++k) {
        const std::uint32_t a = t.indices[3 * k], b = t.indices[3 * k + 1], c = t.indices[3 * k + 2];
        const auto uv = [&t](std::uint32_t i) { return glm::vec2(t.shading[i].uv0[0], t.shading[i].uv0[1]); };
        const glm::vec2 d1 = uv(b) - uv(a), d2 = uv(c) - uv(a);
        const float area = d1.x * d2.y - d1.y * d2.x;
        const glm::vec3 e1 = position(t, b) - position(t, a), e2 = position(t, c) - position(t, a);
        const glm::vec3 along_u = (e1 * d2.y - e2 * d1.y) / area, along_v = (e2 * d1.x - e1 * d2.x) / area;
        if (t.shading[a].uv0[1] < 0.2f || t.shading[a].uv0[1] > 0.8f)
            continue; // the poles turn too fast for flat triangles
        ++checked;
        ASSERT_GT(glm::dot(along_u, tangent(t, a)), 0.0f) << k;
        ASSERT_LT(glm::dot(along_v, bitangent(t, a)), 0.0f) << k;
    }
    EXPECT_GT(checked, 200);
}

glm::mat4 turn(float angle, glm::vec3 axis)
{
    return glm::rotate(glm::mat4(1.0f), angle, glm::normalize(axis));
}

TEST(draw_tables, rotation_scale_and_shear_keep_frames_right)
{
    const glm::mat4 m = glm::translate(glm::mat4(1.0f), {3, -2, 5}) * turn(0.7f, {1, 2, 3}) *
                        glm::scale(glm::mat4(1.0f), {2.0f, 0.3f, 5.0f}) * turn(-1.1f, {0, 1, 1});
    const DrawTables t = placed(m);
    expect_outward(t, {3, -2, 5});
    expect_follows_uv(t);
}

TEST(draw_tables, negative_scales_flip_winding_and_tangent_sign)
{
    for (const glm::vec3& scale : {glm::vec3(-1, 1, 1), glm::vec3(1, -2, 1), glm::vec3(-1, -1, -3), glm::vec3(1, -1, -1)}) {
        const DrawTables t = placed(turn(0.4f, {0, 1, 2}) * glm::scale(glm::mat4(1.0f), scale));
        expect_outward(t, glm::vec3(0.0f));
        expect_follows_uv(t);
        const float sign = scale.x * scale.y * scale.z < 0.0f ? -1.0f : 1.0f;
        EXPECT_EQ(t.shading[100].tangent[3], sign);
    }
}

TEST(draw_tables, normals_go_with_the_inverse_transpose)
{
    const DrawTables t = placed(glm::scale(glm::mat4(1.0f), {1.0f, 0.5f, 1.0f}));
    for (std::uint32_t i = 0; i < t.shading.size(); ++i) { // an ellipsoid: gradient of x^2 + 4 y^2 + z^2
        const glm::vec3 p = position(t, i), want = glm::normalize(glm::vec3(p.x, 4.0f * p.y, p.z));
        ASSERT_LT(glm::length(normal(t, i) - want), 1e-5f);
    }
}

TEST(draw_tables, chains_of_nodes_multiply_from_the_root)
{
    Scene scene = sphere_scene();
    add_node(scene, "root", kNone, glm::translate(glm::mat4(1.0f), {10, 0, 0}));
    add_node(scene, "middle", kNone, turn(1.5707963f, {0, 1, 0}));
    add_node(scene, "leaf", 0, glm::translate(glm::mat4(1.0f), {0, 0, 2}) * glm::scale(glm::mat4(1.0f), {-0.5f, 0.5f, 0.5f}));
    scene.nodes[1].parent = 0;
    scene.nodes[2].parent = 1;
    update_world(scene);
    const DrawTables t = make_draw_tables(scene);
    ASSERT_EQ(t.draws.size(), 1u);
    EXPECT_EQ(t.draws[0].node, 2);
    expect_outward(t, {12, 0, 0}); // +Z of the leaf is +X of the world
    EXPECT_NEAR(t.bounds_min.x, 11.5f, 1e-5f);
    EXPECT_NEAR(t.bounds_max.x, 12.5f, 1e-5f);
    EXPECT_NEAR(t.bounds_max.y, 0.5f, 1e-5f);
}

TEST(draw_tables, instances_are_expanded_in_node_order)
{
    Scene scene = sphere_scene();
    scene.materials.emplace_back();
    scene.primitives.push_back(scene.primitives[0]);
    scene.primitives[1].material = 1;
    scene.meshes[0].primitive_count = 2;
    add_node(scene, "a", 0, glm::mat4(1.0f));
    add_node(scene, "b", 0, glm::translate(glm::mat4(1.0f), {5, 0, 0}));
    update_world(scene);
    const DrawTables t = make_draw_tables(scene);
    ASSERT_EQ(t.draws.size(), 4u);
    for (std::uint32_t d = 0; d < 4; ++d) {
        const Draw& draw = t.draws[d];
        EXPECT_EQ(draw.node, static_cast<int>(d / 2));
        EXPECT_EQ(draw.material, static_cast<int>(d % 2));
        EXPECT_EQ(draw.first_triangle, d * draw.triangle_count);
        EXPECT_EQ(draw.first_vertex, d * draw.vertex_count);
        for (std::uint32_t k = 0; k < draw.triangle_count; ++k)
            ASSERT_EQ(t.triangle_material[draw.first_triangle + k], d % 2);
    }
    EXPECT_EQ(t.px.size(), 4u * scene.vertices.size());
    EXPECT_EQ(t.triangle_material.size(), t.triangle_count());
}

TEST(draw_tables, an_expansion_beyond_the_limit_is_an_error_before_memory_is_taken)
{
    Scene scene = sphere_scene();
    Limits limits;
    const std::size_t vertices = scene.vertices.size();
    scene.nodes.clear();
    for (int i = 0; i < 1000; ++i) {
        Node node;
        node.mesh = 0;
        scene.nodes.push_back(node);
    }
    EXPECT_TRUE(check_draw_size(scene, limits, "a.gltf"));
    limits.draw_bytes = 999 * vertices * 76;
    const Status status = check_draw_size(scene, limits, "a.gltf");
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ExitCode::bad_input);
    EXPECT_EQ(status.error().file, "a.gltf");
}

TEST(draw_tables, matrices_that_leave_nothing_drop)
{
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (const glm::vec3& scale :
         {glm::vec3(0.0f), glm::vec3(1, 0, 0), glm::vec3(inf, 1, 1), glm::vec3(nan, 1, 1), glm::vec3(3e38f, 3e38f, 3e38f) * 4.0f}) {
        const DrawTables t = placed(glm::scale(glm::mat4(1.0f), scale));
        EXPECT_TRUE(t.draws.empty());
        EXPECT_EQ(t.triangle_count(), 0u);
        EXPECT_EQ(t.px.size(), 0u);
    }
    Scene scene = sphere_scene(); // finite matrix, but the vertices overflow
    scene.vertices.px[7] = 1e20f;
    add_node(scene, "far", 0, glm::scale(glm::mat4(1.0f), glm::vec3(1e20f)));
    add_node(scene, "near", 0, glm::mat4(1e-20f));
    update_world(scene);
    const DrawTables t = make_draw_tables(scene);
    ASSERT_EQ(t.draws.size(), 1u);
    EXPECT_EQ(t.draws[0].node, 1);
    EXPECT_EQ(t.px.size(), scene.vertices.size());
}

TEST(draw_tables, solids_pressed_flat_stay_with_normals_across)
{
    const DrawTables t = placed(turn(0.3f, {1, 0, 0}) * glm::scale(glm::mat4(1.0f), {1, 0, 1}));
    ASSERT_EQ(t.draws.size(), 1u);
    const glm::vec3 up = glm::mat3(turn(0.3f, {1, 0, 0})) * glm::vec3(0, 1, 0);
    for (std::uint32_t i = 0; i < t.shading.size(); ++i) {
        ASSERT_NEAR(glm::length(normal(t, i)), 1.0f, 1e-6f);
        ASSERT_NEAR(glm::dot(tangent(t, i), normal(t, i)), 0.0f, 1e-6f);
        if (t.shading[i].uv0[1] < 0.4f) {
            ASSERT_GT(glm::dot(normal(t, i), up), 0.999f);
        }
    }
}

TEST(draw_tables, an_empty_scene_has_a_unit_box)
{
    const DrawTables t = make_draw_tables(Scene{});
    EXPECT_EQ(t.bounds_max - t.bounds_min, glm::vec3(1.0f));
    EXPECT_EQ(t.bounds_max + t.bounds_min, glm::vec3(0.0f));
}

DrawTables lit(const Light& light, const glm::mat4& local)
{
    Scene scene;
    scene.lights.push_back(light);
    add_node(scene, "light", kNone, local);
    scene.nodes[0].light = 0;
    update_world(scene);
    return make_draw_tables(scene);
}

TEST(draw_tables, lights_come_to_world_space)
{
    const glm::mat4 m =
        glm::translate(glm::mat4(1.0f), {1, 2, 3}) * turn(-1.5707963f, {1, 0, 0}) * glm::scale(glm::mat4(1.0f), glm::vec3(4.0f));
    Light light;
    light.type = LightType::spot;
    light.color = {1.0f, 0.5f, 0.25f};
    light.intensity = 8.0f;
    light.range = 5.0f;
    light.inner_cone = 0.2f;
    light.outer_cone = 0.5f;
    const DrawTables t = lit(light, m);
    ASSERT_EQ(t.lights.size(), 1u);
    const PunctualLight& spot = t.lights[0];
    EXPECT_EQ(spot.position, glm::vec3(1, 2, 3));
    EXPECT_LT(glm::length(spot.direction - glm::vec3(0, -1, 0)), 1e-6f);
    EXPECT_EQ(spot.radiant, glm::vec3(8, 4, 2));
    EXPECT_NEAR(spot.inv_range2, 0.04f, 1e-8f);
    EXPECT_NEAR(std::cos(0.2f) * spot.spot_scale + spot.spot_offset, 1.0f, 1e-5f);
    EXPECT_NEAR(std::cos(0.5f) * spot.spot_scale + spot.spot_offset, 0.0f, 1e-5f);

    light.type = LightType::point;
    const PunctualLight point = lit(light, glm::mat4(0.0f) + glm::scale(glm::mat4(1.0f), glm::vec3(0.0f))).lights.at(0);
    EXPECT_EQ(point.spot_scale, 0.0f);
    EXPECT_EQ(point.spot_offset, 1.0f);
    light.type = LightType::directional;
    const PunctualLight sun = lit(light, m).lights.at(0);
    EXPECT_TRUE(sun.directional);
    EXPECT_EQ(sun.inv_range2, 0.0f);
    EXPECT_TRUE(lit(light, glm::scale(glm::mat4(1.0f), glm::vec3(0.0f))).lights.empty());
}

} // namespace
} // namespace burnish
