// Meshes from arrays in memory.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

struct MeshInput {
    std::string name;
    std::span<const glm::vec3> positions{};     // metres
    std::span<const glm::vec3> normals{};       // one a vertex, of any length but 0; empty: smooth ones are made, weighted by area
    std::span<const glm::vec2> coordinates{};   // one a vertex, (0,0) is the picture's upper left; empty: none
    std::span<const std::uint32_t> triangles{}; // 3 vertices each, counter-clockwise seen from the front; empty: vertices in order
    glm::mat4 transform{1.0f};                  // to world space
    Material material{};
};

// Appends a mesh with its node and material. Tangents follow the coordinates. Anisotropic materials need coordinates, since the highlight
// runs along their first axis: a mesh without them gets a line in Scene::warnings. A mesh needs a triangle with an area. Returns the index
// of the node. Errors: ExitCode::usage and bad_input with the place of the first fault,
// "/meshes/0/triangles/5"; the scene is unchanged then.
Result<std::int32_t> add_mesh(Scene& scene, const MeshInput& mesh);

} // namespace burnish
