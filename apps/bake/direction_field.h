// Makes rotation maps that align a mesh's grain with one direction in space.
#pragma once
#include <glm/glm.hpp>

#include "apps/cli/values.h"
#include "core/image/image.h"
#include "core/scene/draw_tables.h"

namespace burnish {

struct DirectionField {
    Image directions;                                // 3 floats a texel, as input to encoded_rotations()
    std::size_t covered = 0, without = 0, twice = 0; // texels on the mesh; with the direction along the normal; in two triangles
};

// Projects the direction into the surface, along tangent and bitangent of the first texture coordinates. Extends islands by some texels,
// for filters. The first triangle on a texel counts; texels far from the mesh point along the tangent.
DirectionField bake_direction_field(const DrawTables& tables, const glm::vec3& direction, const PictureSize& size);

} // namespace burnish
