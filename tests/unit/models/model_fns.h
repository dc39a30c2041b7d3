// Every reflection model as kernels of the lane harness.
#pragma once
#include "tests/unit/lanes/kernels.h"

namespace burnish::test {

inline constexpr int kMaxParams = 6, kModelInputs = kMaxParams + 6, kSampleOutputs = 7;

struct ModelFns {
    const Kernel& eval;     // params[kMaxParams] wo[3] wi[3] -> value
    const Kernel& pdf;      // params wo wi -> density
    const Kernel& half_pdf; // params wo h -> half-vector density; 0 for models without
    const Kernel& sample;   // params wo xi[3] -> wi[3] weight pdf o_dot_h valid
};

} // namespace burnish::test
