// Parametric surfaces sampled on grids, one grid after another in a primitive: how geometry that no file holds becomes tables.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "core/scene/scene.h"

namespace burnish {

struct SurfacePoint {
    glm::dvec3 position{0.0}; // metres, object space
    glm::dvec3 normal{0.0};   // any length above 0
    glm::dvec3 tangent{0.0};  // not along the normal
    double u = 0.0, v = 0.0;  // texture coordinates, v = 0 is the top row
    double shade = 1.0;       // vertex colour, gray
};

using Surface = std::function<SurfacePoint(int column, int row)>;

std::uint32_t begin_primitive(Scene& scene, std::int32_t material); // its id

// Appends (columns + 1) x (rows + 1) vertices and their triangles to the last primitive. Front faces lie
// where columns turn into rows counter-clockwise; bitangents are cross(normal, tangent). Triangles come in 8
// x 8 blocks of quads, so that a cluster is compact; those that have collapsed, as at a pole, are left out.
void add_grid(Scene& scene, int columns, int rows, const Surface& surface);

// A mesh of the primitives from `first_primitive` on, and a node that places it; returns the mesh.
std::int32_t add_mesh(Scene& scene, const char* name, std::uint32_t first_primitive);
void add_node(Scene& scene, const char* name, std::int32_t mesh, const glm::mat4& local);

} // namespace burnish
