// Writes PNG through libpng alone, which loads fast.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// Encodes 8-bit samples as PNG, marked as sRGB; 1 to 4 channels, alpha as stored. `path` names the file in errors,
// which have ExitCode::output_failed.
Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image& image);

} // namespace burnish
