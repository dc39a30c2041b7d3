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
    RenderArguments render; // its scene, msaa and technique are not used
    std::vector<std::string> scenes, techniques = technique_names();
    std::vector<int> msaa = {1, 4, 8};
    std::vector<std::string> also;
    std::string suite, models, json, csv, junit, html;
};

struct ParityPlace {         // a scene, seen from somewhere
    std::string scene, view; // view: a name; empty: the scene's own
    std::optional<glm::dvec3> eye, target;
};

struct ParitySet {                     // one look of all places
    std::string also;                  // what --also said of it; the first one: nothing
    std::vector<RenderOptions> frames; // by technique, then by msaa
};

struct ParityOptions {
    std::vector<ParityPlace> places;
    std::vector<ParitySet> sets;
    std::string json, csv, junit, html; // files; empty: none
};

OptionTable parity_option_table(ParityArguments& to);
Result<ParityOptions> check_parity_options(const ParityArguments& arguments, const OptionTable& given);

} // namespace burnish
