// Pages with the renderer inside: their scripts, scenes and files.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/serve/request.h"
#include "core/base/result.h"

namespace burnish {

// Appends the options that a page may set, of those that were given.
void add_served(const OptionTable& given, DrawRequest& to);

// Returns the request of options of `burnish render`. Returns nothing where one of them reads or writes a further file, or is no page's.
std::optional<DrawRequest> live_request(const OptionTable& given);

struct LiveRow {
    std::string key;     // of the page
    DrawRequest request; // what is drawn first; pictures of this size are compared with the page's hash
};

struct LiveWish {
    std::vector<LiveRow> rows;
    std::string renderer_folder; // of burnish_core.mjs and burnish_core.wasm; empty: looked for beside the program
    Limits limits;
    int threads = 0;
};

struct LiveParts {
    std::string html;    // scripts, for the end of the page: renderer, scenes, window.burnish_live
    std::string picture; // the first row's, as PNG
};

// Returns an error without a renderer for pages, before minutes of other work.
Status check_renderer(const std::string& folder);

// Draws each row once, for its hash. Errors: those of drawing; ExitCode::unavailable without a renderer for pages.
Result<LiveParts> live_parts(const LiveWish& wish);

// Returns the page of `burnish serve` with one row inside: a file that anybody can open or host.
Result<std::string> live_page(const LiveWish& wish);

} // namespace burnish
