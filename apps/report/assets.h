// Files of this folder, embedded as text at build time.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kChartPageStyle;  // page.css
extern const EmbeddedFile kChartPageScript; // page.js

} // namespace burnish
