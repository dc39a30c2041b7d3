// Writes a page that holds a scene and the renderer: a file that anybody can open or host.
#pragma once
#include <string>
#include <vector>

#include "apps/serve/request.h"
#include "core/base/result.h"

namespace burnish {

struct PageWish {
    DrawRequest request;         // what the page shows first; its size is that of the picture whose bits the page proves
    std::string renderer_folder; // of burnish_core.mjs and burnish_core.wasm; empty: looked for beside the program
    Limits limits;
    int threads = 0;
};

// Returns the page's text. Draws its picture once here. Errors: those of drawing; ExitCode::unavailable without a renderer for pages.
Result<std::string> page_text(const PageWish& wish);

} // namespace burnish
