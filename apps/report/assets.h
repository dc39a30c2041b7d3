// Files of this folder as text, put into the program when it is built (embed.cmake).
#pragma once

namespace burnish {

extern const char* const kChartPageStyle;  // page.css
extern const char* const kChartPageScript; // page.js
extern const char* const kStrokeFont;      // stroke_font.jhf

} // namespace burnish
