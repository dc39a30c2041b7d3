// techniques.glsl after the C preprocessor, embedded at build time.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kFlatTechniques;

} // namespace burnish
