// Drawings as SVG text.
#pragma once
#include <string>

#include "apps/report/drawing.h"

namespace burnish {

// `style`: CSS that goes into it, for files of their own; numbers have two digits behind the point.
std::string svg_of(const Drawing& drawing, const std::string& style = "");

} // namespace burnish
