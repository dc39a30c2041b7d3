// LDR-FLIP in double, straight from its definition: two-dimensional kernels, library functions, no tiles.
#pragma once
#include <vector>

#include "core/image/image.h"

namespace burnish::test {

// One error a pixel, of f32 RGB pictures in [0,1].
std::vector<double> flip_by_definition(const Image& reference, const Image& test, double ppd);

} // namespace burnish::test
