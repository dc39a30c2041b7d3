// Files of this folder, embedded as text at build time.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kAtlasBlessed; // blessed.txt

} // namespace burnish
