// What `burnish chart` measures: the techniques, how many samples each takes, and the surfaces that it is tried on.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct Sweeps {    // values in the order given, each once; empty: not swept
    struct Named { // any other option of the picture
        std::string option;
        std::vector<std::string> values;
    };
    std::vector<int> samples;
    std::vector<float> roughness, anisotropy;
    std::vector<Named> others;
};

// "samples=1,2,4", "roughness=0.1,0.5", "anisotropy=-0.9,0,0.9" or NAME=VALUES of another option into its list; values that have commas
// are kept apart by colons. Each list may be given once. Whether NAME is an option, and what it takes, is not looked at.
Status parse_sweep(const std::string& text, Sweeps& into);

struct Setting {
    std::string technique;
    int samples = 1;
    bool sampled = false; // the technique takes samples at all
};
// Without a sweep of samples: the technique's own number and powers of two around it. Numbers that a technique rounds to the same
// one give one setting. By technique in the order given, then by samples.
std::vector<Setting> settings_of(const std::vector<std::string>& techniques, const std::vector<int>& samples);

struct Cell {                                                     // what a place has of its own
    std::optional<float> roughness, anisotropy;                   // overrides of every material; empty: as the scene has it
    std::vector<std::pair<std::string, std::string>> others = {}; // options that are swept besides, with their values
    bool operator==(const Cell&) const = default;
};
std::vector<Cell> cells_of(const Sweeps& sweeps);
double cell_count(const Sweeps& sweeps); // how many that would be
std::string describe(const Cell& cell);  // "roughness 0.2, anisotropy 0.9, axis-k 2", or "the scene's own surfaces"

// The setting that stands for a technique where only one can be shown: of `samples` the one nearest to the technique's own number.
int representative_samples(const std::string& technique, const std::vector<int>& samples);

} // namespace burnish
