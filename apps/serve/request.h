// A page's wish: a scene, an environment and options of `burnish render` by name.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/option.h"
#include "apps/options/options.h"
#include "apps/report/json.h"
#include "core/base/limits.h"
#include "core/base/result.h"

namespace burnish {

struct ServedFile {
    std::string name; // as the page shows it: "builtin:teapot", or a path below the folder
    std::string path; // as options take it
    bool operator==(const ServedFile&) const = default;
};

struct ServedLists {
    std::vector<ServedFile> scenes, environments;
    bool operator==(const ServedLists&) const = default;
};
// Lists built-in scenes and environments, and all in a folder and below it, or a file with the environments beside it. At most
// kMostServed of each. Errors: ExitCode::bad_input.
inline constexpr std::size_t kMostServed = 1000;
Result<ServedLists> served_lists(const std::string& target);

struct DrawRequest {
    std::string scene, environment;                           // paths; environment empty: the scene's own light
    std::vector<std::pair<std::string, std::string>> options; // "--roughness", "0.3"; flags: ""
    int width = 0, height = 0;
    int reduction = 1;         // 1, 2, 4 or 8: divides the sides; above 1 with one sample a pixel
    int reference_samples = 0; // a pixel of the Monte Carlo reference; 0: none
    bool operator==(const DrawRequest&) const = default;
};

// Reads a request's body. Errors: ExitCode::usage for a text that is no JSON, or nests deeper than requests do.
Result<Json> request_json(const std::string& text);

// Reads {scene, environment, options: {name: value}, width, height, reduction, reference_samples}. Names must be in the lists, and options
// must be served. Errors: ExitCode::usage.
Result<DrawRequest> draw_request_of(const Json& json, const ServedLists& lists);

// Returns true for options that a page may set: options of the picture, which neither read nor write a file.
bool is_served(const Option& option);
Json served_options(const OptionTable& table); // [{name, group, help, kind, low, high, names, initial}]

// The request's options of `burnish render`. `arguments` receives their values.
Result<RenderOptions> render_options_of(const DrawRequest& request, const Limits& limits, int threads, RenderArguments& arguments);
// Returns a line for a shell that draws the same picture. further: words that follow, such as limits.
std::string command_of(const DrawRequest& request, const std::vector<std::string>& further = {});

// Part of the request that a prepared session depends on, as text.
std::string session_key(const DrawRequest& request, const RenderOptions& options);

} // namespace burnish
