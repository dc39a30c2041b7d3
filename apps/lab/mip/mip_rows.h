// `burnish chart --mip`: errors of every mip filter, level by level, on procedural and photographed materials.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/report/json.h"
#include "core/jobs/jobs.h"
#include "shading/bake/mip/mip_error.h"
#include "shading/lab/mipnet/families.h"

namespace burnish {

struct MipRow {
    std::string set, family, material, brdf, filter;
    int level = 0;               // from 1 on
    bool hardest = false;        // in the quarter of its set and model with baseline's largest errors (L1, mean over levels)
    MipError error;              // flip is 0 for levels with fewer than 16 texels a side
    double ms = 0.0;             // wall-clock time for all levels of the material
    std::optional<double> gap{}; // closed share of the L1 gap from baseline (0) to optimised levels (1); none without a gap
};

inline constexpr int kMipRowLevels = 5;

struct MipRowOptions {
    float kappa;
    bool gains = false; // with the levels' reflectance gains
};

// Measures every filter of shading/models.def on every material, levels 1 to 5. Rows are in order of material, model, filter, level. The
// set "crossed" also has the filter "two lobes": two lobes a texel, found by search.
std::vector<MipRow> mip_rows(const std::vector<mipnet::TestMaterial>& set, const std::vector<mipnet::Lobe>& lobes,
                             const MipRowOptions& options, const Jobs& jobs);

Json mip_rows_json(const std::vector<MipRow>& rows);
std::string mip_rows_csv(const std::vector<MipRow>& rows);
// Returns means times 1000, one line each: by set, by family and over the hardest quarters. Each line has the change from baseline's L1,
// the closed share of the gap, and the error of mean radiance (mean and largest).
std::string mip_summary(const std::vector<MipRow>& rows);

} // namespace burnish
