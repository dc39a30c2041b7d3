// The options of `burnish parity`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/render_options.h"

namespace burnish {

struct ParityArguments { // as typed
    RenderArguments render; // its scene, msaa and technique are not used
    std::vector<std::string> scenes;
    std::string suite, models, technique = "all", msaa, json, junit, html, shaders;
};

struct ParityPlace { // a scene, seen from somewhere
    std::string scene, view; // view: a name; empty: the scene's own
    std::optional<glm::vec3> eye, target;
};

struct ParityOptions {
    std::vector<ParityPlace> places;
    std::vector<RenderOptions> frames; // by technique, then by msaa
    std::string json, junit, html;     // files; empty: none
};

void add_parity_options(CLI::App& app, ParityArguments& arguments);
Result<ParityOptions> check_parity_options(const ParityArguments& arguments);

} // namespace burnish
