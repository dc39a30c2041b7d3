// One primitive as un-indexed corners: missing normals and tangents are made, then equal vertices become one.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "core/scene/gltf/document.h"
#include "core/scene/gltf/views.h"

namespace burnish::gltf {

struct Attributes {
    AccessorView position, normal, tangent, uv[2], color; // false where the primitive has none
};

struct Corners {
    Attributes attributes;
    std::vector<std::uint32_t> vertices; // three a triangle: the file's vertex of each corner
    std::vector<glm::vec3> normals;      // by corner, unit
    std::vector<glm::vec4> tangents;     // by corner, unit and orthogonal to the normal; w = +1 or -1
};

// From the file; flat where it has none (glTF 2.0, 3.7.2.1). True if a normal of the file had no length.
bool make_normals(Corners& corners);

// From the file where usable, else MikkTSpace from texture coordinate set `uv_set`, else any direction.
enum class TangentSource { file, texture_coordinates, none };
TangentSource make_tangents(Corners& corners, int uv_set);

// Appends the corners to the scene's tables, equal vertices once, in the order of their first use.
void append_welded(Document& doc, const Corners& corners, Primitive& primitive, const std::string& place);

} // namespace burnish::gltf
