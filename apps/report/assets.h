// Files of this folder as text, put into the program when it is built.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kChartPageStyle;  // page.css
extern const EmbeddedFile kChartPageScript; // page.js
extern const EmbeddedFile kStrokeFont;      // stroke_font.jhf

} // namespace burnish
