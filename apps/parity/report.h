// The outcome of `burnish parity`: rows, verdict, files.
#pragma once
#include <string>
#include <vector>

#include "apps/parity/rays.h"
#include "apps/parity/stages.h"

namespace burnish {

struct ParityRow {
    std::string scene, view, technique; // view: "" for the scene's own view
    std::string also;                   // additional options: see --also
    int msaa = 1;
    std::string sampler, pipeline;
    bool samples_emulated = false;
    bool gpu = false;             // a graphics processor, where Vulkan lets division and square roots be inexact
    std::uint64_t pixel_hash = 0; // the tile renderer's picture
    ParityCounts counts;
    RayCounts rays; // the device's visibility against rays
    double flip_mean = 0.0;
    std::vector<CauseShare> causes;        // for differing pixels
    Error error{ExitCode::ok, "", "", ""}; // other than ok: the reason why nothing was compared
    bool failed() const { return error.code != ExitCode::ok; }
};

struct ParityReport {
    std::string driver, device, api, processor, version;
    int width = 0, height = 0;
    std::vector<ParityRow> rows;
};

// Limits for a row. On a CPU device, with an exact sampler and visibility first, every word is equal in all stages but visibility. Over all
// such rows, one visibility sample in a million may differ. Other pictures must look the same.
inline constexpr double kMaxVisibilityShare = 1e-6, kMaxFlipMean = 0.002;
bool bits_promised(const ParityRow& row);
std::string fault_of(const ParityRow& row); // empty: within the limits, visibility aside
// Returns the fault of visibility over all rows, or an empty string.
std::string visibility_fault(const ParityReport& report);
bool passed(const ParityReport& report);
// Returns 0 if all rows hold their limits, else 1 if any row differs. Without a difference, returns the code of the first row that could
// not be compared, where 77 (unavailable) gives way to any other code.
ExitCode outcome(const ParityReport& report);

std::string describe(const ParityRow& row);          // one line
std::string stage_table(const ParityReport& report); // sums over all rows, one line a stage
std::string parity_json(const ParityReport& report);
std::string parity_csv(const ParityReport& report); // rows without their stages
std::string parity_junit(const ParityReport& report);
std::string parity_html(const ParityReport& report);

} // namespace burnish
