// Chart item looks, by class: one table for the SVG style sheet and for the painter.
#pragma once
#include <string>

#include "apps/report/drawing.h"

namespace burnish {

struct ChartLineStyle {
    const char *css_class, *tint; // tint: null: the family's colour
    double width, opacity;        // px, [0,1]
    double on, off;               // px of dashes and gaps; 0: solid
};

struct ChartTextStyle {
    double size = 13.0; // px of the em
    bool bold = false, slanted = false;
    double halo = 0.0; // px of paper around the letters, to separate them from lines behind
    Paint paint{};     // on light paper
};

inline constexpr double kMarkWidth = 1.6; // px of a mark's outline

Paint tint(const std::string& name);                        // a name in kTints, on light paper
Paint family(const std::string& classes);                   // the colour of classes c0, c1, c1a..., else the ink
const ChartLineStyle* chart_line_style(const std::string&); // for lines with these classes; null: invisible
ChartTextStyle chart_text_style(const std::string& classes);

std::string chart_style(); // CSS, for svg.chart

} // namespace burnish
