// Options of `burnish bake ltc`, which makes or measures an LTC table (linearly transformed cosines) in burnish-lab.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/lab.h"
#include "apps/cli/option.h"
#include "apps/pieces/pieces.h"

namespace burnish {

enum class LtcNorm { l1, l3, sliced }; // as ltc::Norm

struct LtcArguments {
    std::string table, report;
    int resolution = 8, steps = 12, samples = 8, cosines = 1;
    LtcNorm norm = LtcNorm::l1;
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
    const PieceOptions& pieces;
};
inline LabPart<LtcBake, OptionTable> bake_ltc; // with the options present on the command line

} // namespace burnish
