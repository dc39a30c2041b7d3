// `burnish bake lobe`: maps of the lobes that heights reflect as.
#pragma once
#include <string>

#include "apps/cli/values.h"
#include "core/base/limits.h"

namespace burnish {

struct LobeArguments {
    std::string heights, output, preview; // a picture, and folders
    PictureSize size;                     // of the maps; 0x0: by the heights
    double depth = 0.05;                  // texture lengths
    std::string brdf;                     // a reflection model's name
    Limits limits;
    int threads = 0, verbosity = 0;
    bool quiet = false;
};

// Fits, writes and reports. Returns the exit code.
int run_lobe(const LobeArguments& arguments);

} // namespace burnish
