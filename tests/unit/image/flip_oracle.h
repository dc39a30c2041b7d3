// LDR-FLIP in double, directly from its definition: two-dimensional kernels, library functions, no tiles.
#pragma once
#include <vector>

#include "core/image/image.h"

namespace burnish::test {

// Returns one error a pixel for f32 RGB images in [0,1].
std::vector<double> flip_by_definition(const Image& reference, const Image& test, double ppd);

} // namespace burnish::test
