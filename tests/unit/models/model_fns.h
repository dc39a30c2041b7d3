// Every reflection model as kernels of the harness.
#pragma once
#include "tests/unit/lanes/kernels.h"

namespace burnish::test {

inline constexpr int kMaxParams = 6, kModelInputs = kMaxParams + 6, kSampleOutputs = 7;

struct ModelFns {
    const Kernel& eval;     // params[kMaxParams] wo[3] wi[3] -> value
    const Kernel& pdf;      // the same
    const Kernel& half_pdf; // params wo h -> density of half vectors; 0 for models without
    const Kernel& sample;   // params wo xi[3] -> wi[3] weight pdf o_dot_h valid
};

} // namespace burnish::test
