// The colour map of FLIP's error images: magma, from black (no error) over violet and orange to pale yellow.
#pragma once
#include "core/image/image.h"

namespace burnish {

// One float channel in [0,1] to 8-bit sRGB. Values outside are clamped, NaN is 0.
Image magma_map(const Image& error);

} // namespace burnish
