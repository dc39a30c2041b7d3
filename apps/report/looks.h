// How the pieces of a chart look, by their classes: one table that the style sheet of SVG and the painter of pictures follow.
#pragma once
#include <string>

#include "apps/report/drawing.h"

namespace burnish {

struct LineLook {
    const char *css_class, *tint; // tint: null: the family's
    double width, opacity;        // px, [0,1]
    double on, off;               // px of dashes and gaps, 0: none
};

struct TextLook {
    double size = 13.0; // px of the em
    bool bold = false, slanted = false;
    double halo = 0.0; // px of paper around the letters, so that what they cross does not run through them
    Paint paint{};     // on light paper
};

inline constexpr double kMarkWidth = 1.6; // px of a mark's outline

Paint tint(const std::string& name);           // of kTints, on light paper
Paint family(const std::string& classes);      // the colour that the classes c0, c1, c1a... give, else the ink's
const LineLook* line_look(const std::string&); // of what lines with these classes; null: it is not seen
TextLook text_look(const std::string& classes);

std::string chart_style(); // CSS, for svg.chart

} // namespace burnish
