// Maps of rotations that lay the grain of a mesh along one direction of space.
#pragma once
#include <glm/glm.hpp>

#include "apps/cli/values.h"
#include "core/image/image.h"
#include "core/scene/draw_tables.h"

namespace burnish {

struct Straightened {
    Image directions;                                // 3 floats a texel, as encoded_rotations() takes them
    std::size_t covered = 0, without = 0, twice = 0; // texels on the mesh; where the direction is along the normal; in two triangles
};

// The direction's part in the surface, along tangent and bitangent of the mesh's first texture coordinates. Around islands it goes on for
// some texels, for filters. Of texels in two triangles the first counts; what no triangle is near lies along the tangent.
Straightened straighten(const DrawTables& tables, const glm::vec3& direction, const PictureSize& size);

} // namespace burnish
