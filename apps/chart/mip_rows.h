// `burnish chart --mip`: what every mip filter gets wrong, level by level, of materials that are made in code and of pictured ones.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/report/json.h"
#include "core/jobs/jobs.h"
#include "shading/bake/mip/shown.h"
#include "shading/bake/mipnet/families.h"

namespace burnish {

struct MipRow {
    std::string set, family, material, brdf, filter;
    int level = 0;        // from 1 on
    bool hardest = false; // of the quarter of its set and model that baseline gets the most of wrong (L1, mean over levels)
    ShownError error;     // flip of squares of 16 texels a side or more; else 0
    double ms = 0.0;      // all levels of the material, on the clock
    std::optional<double>
        gap{}; // share of L1 from baseline to teacher that is closed: 0 of baseline, 1 of teacher; none where there is no gap
};

inline constexpr int kMipRowLevels = 5;

struct MipRowOptions {
    float kappa;
    bool gains = false; // of levels' reflectances
};

// Every filter of shading/models.def on every material, levels 1 to 5: by material, model, filter, level. Of set "crossed" also filter "two
// lobes", of two lobes a texel by search.
std::vector<MipRow> mip_rows(const std::vector<mipnet::TestMaterial>& set, const std::vector<mipnet::Lobe>& lobes,
                             const MipRowOptions& options, const Jobs& jobs);

Json mip_rows_json(const std::vector<MipRow>& rows);
std::string mip_rows_csv(const std::vector<MipRow>& rows);
// Means by set, by family and of the hardest quarters, times 1000, a line each, with what baseline's L1 changes by, the gap closed, and
// what mean radiance is off by in the mean and at worst.
std::string mip_summary(const std::vector<MipRow>& rows);

} // namespace burnish
