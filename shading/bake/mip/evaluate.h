// Error of mipmaps against the truth: level 0 lit at full resolution, its linear radiance averaged.
#pragma once
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/mip_error.h"
#include "shading/bake/mipnet/families.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish::mipnet {

inline constexpr int kJudgedLevels = 5; // levels 1 to 5, with FLIP for at least 16 texels a side

// Returns the mean L1 over levels 1 to 5, under 24 pairs for each 32 x 32 texel tile. The pairs differ from judge()'s, so that judge() can
// test a choice made by these errors. pyramids: of one square level 0, whose side is a multiple of 32. metal: see compare_on().
std::vector<double> mean_l1(const std::vector<std::vector<Texels>>& pyramids, Lobe lobe, bool metal, const Jobs& jobs);

struct Judged {
    std::string set, material, filter;
    MipError level[kJudgedLevels + 1]; // 0: the mean over levels
};

// Judges the filters of one lobe: baseline, kappa .25, .5 and 1, ssgt or leadr, and the given cascades, called "mipnet", with a number if
// there are several. Each cascade comes with its "auto", which leaves some materials to closed forms (fallback.h).
std::vector<Judged> judge(const std::vector<TestMaterial>& set, Lobe lobe, const std::vector<Weights>& cascades, const Jobs& jobs);

struct Summary {
    std::string set, filter;
    std::size_t materials = 0;
    MipError mean;
    double wins[3] = {};         // share of materials better than baseline: FLIP, L1, MSE
    double worst_l1 = 0.0;       // largest ratio to baseline's L1
    double first_level_l1 = 0.0; // level 1 alone
};
std::vector<Summary> summaries(const std::vector<Judged>& rows); // by set, then filter, in input order

} // namespace burnish::mipnet
