// Pictures of any type as people see them, and in words.
#pragma once
#include <string>

#include "core/image/image.h"

namespace burnish {

// Converts to display values: floats are exposed and tonemapped, 16 bits are reduced to 8.
Image displayed(const Image& image, float exposure_ev);

std::string describe(const Image& image); // "640x480, 3 channels, 8 bits"

} // namespace burnish
