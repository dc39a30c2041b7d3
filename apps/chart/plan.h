// The plan of `burnish chart`: techniques, their sample counts, and the surfaces they are tried on.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/plan/plan.h"
#include "core/base/result.h"
#include "raster/frame/frame.h"

namespace burnish {

struct Sweeps {    // values in the order given, without repeats; empty: no sweep
    struct Named { // any other picture option
        std::string option;
        std::vector<std::string> values;
    };
    std::vector<int> samples;
    std::vector<float> roughness, anisotropy;
    std::vector<Named> others;
};

// Parses "samples=1,2,4", "roughness=0.1,0.5", "anisotropy=-0.9,0,0.9" or NAME=VALUES into the option's list. Values with commas inside
// are separated by colons. Each list may be given once. Does not check NAME or its values against the option table.
Status parse_sweep(const std::string& text, Sweeps& into);

inline constexpr const char* kPlanned = "planned"; // in a technique's place: a plan chose one for each material

struct Setting {
    std::string technique;
    int samples = 1;
    bool sampled = false;      // the technique takes samples
    double budget = 0.0;       // of the plan: largest mean HDR-FLIP; 0: no plan
    PlannedFrame planned = {}; // of the plan
};
std::string describe(const Setting& setting); // "major_axis, 16 samples", "bent_normal", "planned, budget 0.03"
// Returns the settings by technique in the order given, then by samples. Without a sweep, samples are the technique's default and powers
// of two around it. Counts that a technique rounds to the same number give one setting.
std::vector<Setting> settings_of(const std::vector<std::string>& techniques, const std::vector<int>& samples);

struct Cell {                                                     // surface overrides at a place
    std::optional<float> roughness, anisotropy;                   // for every material; empty: the scene's own value
    std::vector<std::pair<std::string, std::string>> others = {}; // further swept options and their values
    bool operator==(const Cell&) const = default;
};
std::vector<Cell> cells_of(const Sweeps& sweeps);
double cell_count(const Sweeps& sweeps); // size of cells_of(), without making them
std::string describe(const Cell& cell);  // "roughness 0.2, anisotropy 0.9, axis-k 2", or "the scene's own surfaces"

// Parses "0.003,0.01,0.03": mean errors above 0 and up to 1, without repeats.
Status parse_budgets(const std::string& text, std::vector<double>& into);

// Returns the sample count to show for a technique if there is room for one: the count of `samples` nearest to the technique's default.
int representative_samples(const std::string& technique, const std::vector<int>& samples);

} // namespace burnish
