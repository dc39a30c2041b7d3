// The WebAssembly module has no code of its own: it exports the C interface (raster/session/burnish.h).
#include "raster/session/burnish.h"

static_assert(BURNISH_API_VERSION >= 4);
