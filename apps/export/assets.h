// Embedded at build time: techniques.glsl after the C preprocessor; the scripts of a page with the renderer inside.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kFlatTechniques;
extern const EmbeddedFile kPageLive, kPageWorker;

} // namespace burnish
