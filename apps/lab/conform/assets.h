// Files of this folder, embedded as text at build time.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kConformReadme;   // folder.md
extern const EmbeddedFile kConformThree;    // three.html
extern const EmbeddedFile kConformBabylon;  // babylon.html
extern const EmbeddedFile kConformPictures; // pictures.js
extern const EmbeddedFile kConformStyle;    // page.css

} // namespace burnish
