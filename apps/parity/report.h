// The outcome of `burnish parity`: rows, verdict, files.
#pragma once
#include <string>
#include <vector>

#include "apps/parity/stages.h"

namespace burnish {

struct ParityRow {
    std::string scene, view, technique; // view: "" for the scene's own
    std::string also;                   // options beside those of the command: see --also
    int msaa = 1;
    std::string sampler, pipeline;
    bool samples_emulated = false;
    std::uint64_t pixel_hash = 0; // of the tile renderer's picture
    ParityCounts counts;
    double flip_mean = 0.0;
    std::vector<CauseShare> causes;        // of the pixels that differ
    Error error{ExitCode::ok, "", "", ""}; // other than ok: nothing was compared, and why
    bool failed() const { return error.code != ExitCode::ok; }
};

struct ParityReport {
    std::string driver, device, api, processor, version;
    int width = 0, height = 0;
    std::vector<ParityRow> rows;
};

// The promise of a row. Exact sampler, visibility first: no word differs in any stage but visibility, of which all rows together may have
// one sample in a million. Otherwise: pictures that look the same.
inline constexpr double kMaxVisibilityShare = 1e-6, kMaxFlipMean = 0.002;
bool bits_promised(const ParityRow& row);
std::string fault_of(const ParityRow& row); // empty: as promised, visibility aside
// Of all rows together: empty, or what is wrong.
std::string visibility_fault(const ParityReport& report);
bool passed(const ParityReport& report);
// 0 where all is as promised; otherwise 1 where any row differs, or what the first row that could not be compared ends with
// (77 only where nothing worse does).
ExitCode outcome(const ParityReport& report);

std::string describe(const ParityRow& row);          // one line
std::string stage_table(const ParityReport& report); // sums over all rows, a line a stage
std::string parity_json(const ParityReport& report);
std::string parity_csv(const ParityReport& report); // of the rows, without their stages
std::string parity_junit(const ParityReport& report);
std::string parity_html(const ParityReport& report);

} // namespace burnish
