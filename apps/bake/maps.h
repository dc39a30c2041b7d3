// Maps of rotations, made of expressions.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/values.h"
#include "core/base/result.h"
#include "core/scene/surface_maps.h"

namespace burnish {

// A rotation's direction along tangent and bitangent by two expressions of u and v, [0,1] at the texels' centres, v = 0 the top row.
// Errors: ExitCode::usage, with the column of what is no expression, or the texel where one has no finite value or both are 0.
Result<Image> rotations_of(const std::vector<std::string>& expressions, const PictureSize& size);

// Directions, 3 floats a texel, as a map in an encoding that directions_of_rotations() reads.
Image encoded_rotations(const Image& directions, RotationEncoding encoding, PixelType type);

} // namespace burnish
