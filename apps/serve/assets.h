// The page of `burnish serve`, as text in the program.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kServePage;

} // namespace burnish
