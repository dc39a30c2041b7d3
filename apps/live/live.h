// Pages with the renderer inside: their scripts, scenes and files.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/serve/request.h"
#include "core/base/result.h"

namespace burnish {

// Appends the options that a page may set, of those that were given.
void add_served(const OptionTable& given, DrawRequest& to);

// Returns the request of options of `burnish render`. Returns nothing where one of them reads or writes a further file, or is no page's.
std::optional<DrawRequest> live_request(const OptionTable& given);
// Returns the request of a command line. Errors: those of reading its words.
Result<std::optional<DrawRequest>> live_request(const std::vector<std::string>& words);

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
    std::string html;       // scripts, for the end of the page: renderer, scenes, window.burnish_live
    std::string picture;    // the first row's, as PNG
    std::uint64_t hash = 0; // of the first row's pixels
    std::vector<std::string> warnings{};
    std::vector<std::pair<std::string, Error>> left_out{}; // keys of rows that a page cannot draw, and why
};

// Returns an error without a renderer for pages, before minutes of other work.
Status check_renderer(const std::string& folder);

// Draws each row once, for its hash. Without any row that a page can draw, `html` is empty. Errors: ExitCode::unavailable without a
// renderer for pages.
Result<LiveParts> live_parts(const LiveWish& wish);

// Returns the page of `burnish serve` with one row inside, as `html`: a file that anybody can open or host. Errors: those of the row too.
Result<LiveParts> live_page(const LiveWish& wish);

} // namespace burnish
