// Files of this folder, embedded as text at build time.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kAtlasGolden;     // golden_figures.txt
extern const EmbeddedFile kAtlasPageStyle;  // page.css
extern const EmbeddedFile kAtlasPageScript; // page.js

} // namespace burnish
