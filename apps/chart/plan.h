// What `burnish chart` measures: the techniques, how many samples each takes, and the surfaces that it is tried on.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

struct Sweeps { // values in the order given, each once; empty: not swept
    std::vector<int> samples;
    std::vector<float> roughness, anisotropy;
};

// "samples=1,2,4", "roughness=0.1,0.5" or "anisotropy=-0.9,0,0.9" into its list. Each list may be given once.
Status parse_sweep(const std::string& text, Sweeps& into);

struct Setting {
    std::string technique;
    int samples = 1;
    bool sampled = false; // the technique takes samples at all
};
// Without a sweep of samples: the technique's own number and powers of two around it. Numbers that a technique rounds to the same
// one give one setting. By technique in the order given, then by samples.
std::vector<Setting> settings_of(const std::vector<std::string>& techniques, const std::vector<int>& samples);

struct Cell { // an override of every material; empty: as the scene has it
    std::optional<float> roughness, anisotropy;
    bool operator==(const Cell&) const = default;
};
std::vector<Cell> cells_of(const Sweeps& sweeps);
std::string describe(const Cell& cell); // "roughness 0.2, anisotropy 0.9", or "the scene's own surfaces"

// The setting that stands for a technique where only one can be shown: of `samples` the one nearest to the technique's own number.
int representative_samples(const std::string& technique, const std::vector<int>& samples);

} // namespace burnish
