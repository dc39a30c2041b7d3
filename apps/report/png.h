// The charts as PNG, for people whose programs show no SVG or none with style sheets.
#pragma once
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

// Draws what apps/report/svg.h writes, on white paper, kPngScale pixels for each of the chart's. It reads that SVG alone: lines,
// paths of straight lines and half circles, rectangles and text, whose looks are those of marks.css.
inline constexpr int kPngScale = 2;
Image draw_svg(const std::string& svg);

Result<std::string> chart_png(const std::string& svg); // the bytes of the file

} // namespace burnish
