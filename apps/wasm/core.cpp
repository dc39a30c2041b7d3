// The WebAssembly module exports the C interface (raster/session/burnish.h), and page.cpp.
#include "raster/session/burnish.h"

static_assert(BURNISH_API_VERSION >= 4);
