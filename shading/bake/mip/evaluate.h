// How far mipmaps are from the truth: level 0 lit at one to one, its linear radiance averaged.
#pragma once
#include <string>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/shown.h"
#include "shading/bake/mipnet/families.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish::mipnet {

inline constexpr int kJudgedLevels = 5; // levels 1 to 5, FLIP of those of 16 texels a side or more

// Of pyramids of one level 0, which is square, its side a multiple of 32: mean L1 of levels 1 to 5 under 24 pairs a tile of 32 x 32, others
// than judge() has, so that what is chosen by them can be judged. metal: see compare_on().
std::vector<double> mean_l1(const std::vector<std::vector<Texels>>& pyramids, Lobe lobe, bool metal, const Jobs& jobs);

struct Judged {
    std::string set, material, filter;
    ShownError level[kJudgedLevels + 1]; // 0: the mean over levels
};

// Filters of one lobe: baseline, kappa .25, .5 and 1, ssgt or leadr, and the cascades given, "mipnet" and a number where there are several;
// beside each its "auto", which leaves materials to closed forms (fallback.h).
std::vector<Judged> judge(const std::vector<TestMaterial>& set, Lobe lobe, const std::vector<Weights>& cascades, const Jobs& jobs);

struct Summary {
    std::string set, filter;
    std::size_t materials = 0;
    ShownError mean;
    double wins[3] = {};         // share of materials better than baseline: FLIP, L1, MSE
    double worst_l1 = 0.0;       // largest ratio to baseline's L1
    double first_level_l1 = 0.0; // level 1 alone
};
std::vector<Summary> summaries(const std::vector<Judged>& rows); // by set, then filter, as they come

} // namespace burnish::mipnet
