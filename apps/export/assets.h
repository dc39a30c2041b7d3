// techniques.glsl after the C preprocessor, put into the program when it is built.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kFlatTechniques;

} // namespace burnish
