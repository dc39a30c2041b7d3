// Files of this folder as text, put into the program when it is built.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kAtlasBlessed; // blessed.md

} // namespace burnish
