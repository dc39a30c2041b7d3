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

// Appends the options that a page may set, among the given ones.
void add_served(const OptionTable& given, DrawRequest& to);

// Returns the request from options for `burnish render`. Returns nothing where an option reads or writes a further file, or is no page's.
std::optional<DrawRequest> live_request(const OptionTable& given);
// Returns the request from a command line. Errors: as for reading its words.
Result<std::optional<DrawRequest>> live_request(const std::vector<std::string>& words);

struct LiveRow {
    std::string key;     // of the page
    DrawRequest request; // the first picture; pictures of this size are compared with the page's hash
};

struct LiveWish {
    std::vector<LiveRow> rows;
    std::string renderer_folder; // for burnish_core.mjs and burnish_core.wasm; empty: looked for beside the program
    Limits limits;
    int threads = 0;
};

struct LiveParts {
    std::string html;       // scripts, for the page's end: renderer, scenes, window.burnish_live
    std::string picture;    // the first row's, as PNG
    std::uint64_t hash = 0; // the first row's pixels'
    std::vector<std::string> warnings{};
    std::vector<std::pair<std::string, Error>> left_out{}; // keys for rows that a page cannot draw, and why
};

// Returns an error without a renderer for pages, before minutes spent on other work.
Status check_renderer(const std::string& folder);

// Draws each row once, for its hash. Without any row that a page can draw, `html` is empty. Errors: ExitCode::unavailable without a
// renderer for pages.
Result<LiveParts> live_parts(const LiveWish& wish);

// Returns the page from `burnish serve` with one row inside, as `html`: a file that anybody can open or host. Errors: the row's errors too.
Result<LiveParts> live_page(const LiveWish& wish);

} // namespace burnish
