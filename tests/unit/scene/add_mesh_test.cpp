// Meshes from arrays: each fault is an Error that names its place, and leaves the scene as it was.
#include <array>
#include <gtest/gtest.h>

#include "core/scene/add_mesh.h"

namespace burnish {
namespace {

constexpr std::array kSquare = {glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 1, 0), glm::vec3(-1, 1, 0)};
constexpr std::array<std::uint32_t, 6> kTriangles = {0, 1, 2, 0, 2, 3};

MeshInput square()
{
    MeshInput mesh;
    mesh.positions = kSquare, mesh.triangles = kTriangles;
    return mesh;
}

void expect_refused(const MeshInput& mesh, const std::string& place, const std::string& words)
{
    SCOPED_TRACE(place);
    Scene scene;
    const Result<std::int32_t> added = add_mesh(scene, mesh);
    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().place, place);
    EXPECT_NE(added.error().reason.find(words), std::string::npos) << added.error().reason;
    EXPECT_TRUE(scene.nodes.empty() && scene.vertices.size() == 0 && scene.warnings.empty());
}

TEST(add_mesh, counts_are_multiples_of_three)
{
    MeshInput mesh = square();
    mesh.triangles = {};
    expect_refused(mesh, "/meshes/0/triangles", "4 vertices in order are no multiple of 3");
    mesh = square();
    mesh.triangles = std::span(kTriangles).first(4);
    expect_refused(mesh, "/meshes/0/triangles", "4 indices are no multiple of 3");
}

TEST(add_mesh, normals_have_a_direction)
{
    std::array normals = {glm::vec3(0, 0, 1), glm::vec3(0, 0, 1e-30f), glm::vec3(0), glm::vec3(0, 0, 7)};
    MeshInput mesh = square();
    mesh.normals = normals;
    expect_refused(mesh, "/meshes/0/normals/6", "has no direction");
    const std::array<std::uint32_t, 3> others = {0, 1, 3}; // vertex 2 belongs to no triangle
    mesh.triangles = others;
    Scene scene;
    EXPECT_TRUE(add_mesh(scene, mesh));
}

TEST(add_mesh, positions_have_a_size)
{
    std::array far = kSquare, line = kSquare, tiny = kSquare;
    far[1].y = -1e30f;
    for (glm::vec3& p : line)
        p = glm::vec3(p.x);
    for (glm::vec3& p : tiny)
        p *= 1e-30f;
    MeshInput mesh = square();
    mesh.positions = far;
    expect_refused(mesh, "/meshes/0/positions/4", "too large");
    for (const auto& flat : {line, tiny}) {
        mesh.positions = flat;
        expect_refused(mesh, "/meshes/0/triangles", "no area");
    }
}

TEST(add_mesh, anisotropy_without_coordinates_is_warned_of)
{
    MeshInput mesh = square();
    Scene scene;
    ASSERT_TRUE(add_mesh(scene, mesh));
    EXPECT_TRUE(scene.warnings.empty());
    mesh.material.anisotropy_strength = 0.8f;
    ASSERT_TRUE(add_mesh(scene, mesh));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("/meshes/1"), std::string::npos);
    const std::array coordinates = {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)};
    mesh.coordinates = coordinates;
    ASSERT_TRUE(add_mesh(scene, mesh));
    EXPECT_EQ(scene.warnings.size(), 1u);
}

} // namespace
} // namespace burnish
