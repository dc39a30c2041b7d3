// `burnish bake ltc`: makes or measures an LTC table (linearly transformed cosines).
#pragma once
#include <string>
#include <vector>

#include "apps/cli/option.h"
#include "shading/bake/ltc/node_fit.h"

namespace burnish {

struct LtcArguments {
    std::string table, report;
    int resolution = 8, steps = 12, samples = 8, cosines = 1;
    ltc::Norm norm = ltc::Norm::l1;
    std::string interpolate = "mirror";
    bool unaligned = false, unsymmetric = false, half = false, isotropic = false;
};
std::vector<Option> ltc_options(LtcArguments& to);

struct LtcBake { // with the options common to `burnish bake`
    const LtcArguments& options;
    int brdf; // a lobe (shading/models.def)
    std::string picture, output, preview;
    int threads, verbosity;
    bool quiet;
};
int run_ltc(const LtcBake& bake, const OptionTable& given); // returns the exit code; given: the options present on the command line

} // namespace burnish
