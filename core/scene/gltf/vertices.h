// One primitive as un-indexed corners: makes missing normals and tangents, then merges equal vertices.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/scene/gltf/document.h"
#include "core/scene/gltf/views.h"

namespace burnish::gltf {

struct Attributes {
    AccessorView position, normal, tangent, uv[2], color; // false where the primitive lacks the attribute
};

struct Corners {
    Attributes attributes;
    std::vector<std::uint32_t> vertices; // three for each triangle: the corner's vertex in the file
    std::vector<glm::vec3> normals;      // for each corner, unit
    std::vector<glm::vec4> tangents;     // for each corner, unit and orthogonal to the normal; w = +1 or -1
};

// Takes normals from the file, or flat normals where it has none (glTF 2.0, 3.7.2.1). Returns true if a file normal had
// no length.
bool make_normals(Corners& corners);

// Takes usable tangents from the file, else makes them by MikkTSpace from texture coordinate set `uv_set`, else picks
// any direction.
enum class TangentSource { file, texture_coordinates, none };
TangentSource make_tangents(Corners& corners, int uv_set);

// Appends the corners to the scene's tables. Merges equal vertices, in the order of first use.
void append_welded(Document& doc, const Corners& corners, Primitive& primitive, const std::string& place);

} // namespace burnish::gltf
