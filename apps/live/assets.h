// Scripts of a page with the renderer inside, embedded at build time.
#pragma once
#include "core/base/embedded.h"

namespace burnish {

extern const EmbeddedFile kLiveScript; // live.js
extern const EmbeddedFile kLiveWorker; // worker.js

} // namespace burnish
