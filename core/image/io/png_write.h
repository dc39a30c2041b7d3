// PNG through libpng alone: what a picture for the screen needs, and nothing that takes long to load.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// The bytes of a PNG file of 8-bit samples, marked as sRGB; 1 to 4 channels, alpha as stored. `path` names it
// in errors, which have ExitCode::output_failed.
Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image& image);

} // namespace burnish
