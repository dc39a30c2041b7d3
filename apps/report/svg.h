// Drawings as SVG text.
#pragma once
#include <string>

#include "apps/report/drawing.h"

namespace burnish {

// Returns SVG text with two decimals. `style`: CSS inside the SVG, for separate files.
std::string svg_of(const Drawing& drawing, const std::string& style = "");

} // namespace burnish
