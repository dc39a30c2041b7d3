// techniques.glsl after the C preprocessor, put into the program when it is built.
#pragma once

namespace burnish {

extern const char* const kFlatTechniques;

} // namespace burnish
