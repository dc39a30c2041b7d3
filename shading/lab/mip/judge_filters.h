// Errors of mip filters on sets of materials, and their means.
#pragma once
#include <string>
#include <vector>

#include "shading/bake/mip/evaluate.h"
#include "shading/bake/mipnet/weights.h"
#include "shading/lab/mipnet/families.h"

namespace burnish::mipnet {

struct Judged {
    std::string set, material, filter;
    MipError level[kEvaluatedLevels + 1]; // 0: the mean over levels
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
