// Makes rotation maps from expressions.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/values.h"
#include "core/base/result.h"
#include "core/scene/surface_maps.h"

namespace burnish {

// Returns rotation directions along tangent and bitangent, from two expressions in u and v. u and v are in [0,1] at texel centres, v = 0
// is the top row. Fails with ExitCode::usage and the column of a syntax error, or the texel with a non-finite or zero direction.
Result<Image> rotations_of(const std::vector<std::string>& expressions, const PictureSize& size);

// Encodes directions, 3 floats a texel, for directions_of_rotations().
Image encoded_rotations(const Image& directions, RotationEncoding encoding, PixelType type);

} // namespace burnish
