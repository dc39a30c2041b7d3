// Magma, the colour map of FLIP's error images: from black (no error) over violet and orange to pale yellow.
#pragma once
#include "core/image/image.h"

namespace burnish {

// Maps one float channel in [0,1] to 8-bit sRGB. Clamps values outside; NaN becomes 0.
Image magma_map(const Image& error);

} // namespace burnish
