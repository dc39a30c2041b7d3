// Arguments of `burnish train`, and its two jobs.
#pragma once
#include <string>

#include "apps/cli/option.h"
#include "apps/cli/report.h"
#include "apps/pieces/pieces.h"
#include "core/base/limits.h"
#include "shading/lab/mipnet/train.h"

namespace burnish {

struct TrainArguments {
    std::string what = "mip", output, evaluate, maps, only_maps, from, distilled_from, json, checkpoint;
    std::string size = "2x32/2x64";
    mipnet::TrainOptions train;
    PieceOptions pieces;
    bool validation = false, quiet = false;
    int seeds = 1, verbosity = 0, threads = 0;
    Limits limits;
};

// Trains nets, one for each seed, and writes the best. Returns the exit code.
int run_training(TrainArguments& a, Report& report);
// Measures nets against closed forms. Returns the exit code.
int run_evaluation(const TrainArguments& a, const OptionTable& given, Report& report);

} // namespace burnish
