// techniques.glsl after the C preprocessor, and the engines' modules, embedded at build time.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kFlatTechniques;
extern const EmbeddedFile kThreeModule, kThreeNodeModule, kBabylonModule, kGodotShader, kBevyShader; // templates with @PLACES@

} // namespace burnish
