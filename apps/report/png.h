// Drawings as pixels, for people whose programs show no SVG or none with style sheets.
#pragma once
#include <string>

#include "apps/report/drawing.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// On white paper, kPngScale pixels for each of the drawing's.
inline constexpr int kPngScale = 2;
Image paint(const Drawing& drawing);

Result<std::string> png_of(const Drawing& drawing); // the bytes of the file

} // namespace burnish
