// The options of `burnish parity`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/options/options.h"

namespace burnish {

struct ParityArguments {
    ParityArguments()
    {
        render.size = {128, 72};
        render.plain.backend = "vulkan", render.plain.vulkan.prefer_cpu = true;
    }
    RenderArguments render; // without scene, msaa and technique
    std::vector<std::string> scenes, techniques = technique_names();
    std::vector<int> msaa = {1, 4, 8};
    std::vector<std::string> also;
    std::string suite, models, glsl, json, csv, junit, html;
};

struct ParityPlace {         // a scene and a view
    std::string scene, view; // view: a name; empty: the scene's own view
    std::optional<glm::dvec3> eye, target;
};

struct ParitySet {                     // one option set for all places
    std::string also;                  // text of --also; empty for the first set
    std::vector<RenderOptions> frames; // by technique, then by msaa
};

struct ParityOptions {
    std::vector<ParityPlace> places;
    std::vector<ParitySet> sets;
    std::string glsl;                   // file with a technique in place of the program's, or empty
    std::string json, csv, junit, html; // files; empty: no file
};

OptionTable parity_option_table(ParityArguments& to);
Result<ParityOptions> check_parity_options(const ParityArguments& arguments, const OptionTable& given);

} // namespace burnish
