// The looks of a chart's pieces, by their classes: a table that the style sheet of SVG follows.
#pragma once
#include <string>

namespace burnish {

std::string chart_style(); // CSS, for svg.chart

} // namespace burnish
