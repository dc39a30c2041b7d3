// Renders drawings to pixels, for programs without SVG or without style sheets.
#pragma once
#include <string>

#include "apps/report/drawing.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// Paints on white paper, with kPngScale pixels a drawing unit.
inline constexpr int kPngScale = 2;
Image paint(const Drawing& drawing);

Result<std::string> png_of(const Drawing& drawing); // the bytes of a PNG file

} // namespace burnish
