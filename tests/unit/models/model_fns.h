// Every reflection model, and the functions that go with them, as plain functions over arrays, compiled once
// for each instruction set and for the double oracle from model_fns.isa.cpp.
#pragma once
#include <vector>

#include "core/simd/fns.h"

namespace burnish::test {

inline constexpr int kMaxParams = 6;

// n points; argument i of point k is in[i * n + k], result j is out[j * n + k]. Arguments of float versions
// are rounded to float.
using RunFn = void (*)(int n, const double* in, double* out);

struct ModelFns {
    const char* name;
    RunFn eval;     // params[kMaxParams] wo[3] wi[3] -> value
    RunFn pdf;      // the same
    RunFn half_pdf; // params wo h -> density of half vectors; 0 for models without
    RunFn sample;   // params wo xi[3] -> wi[3] weight pdf o_dot_h valid
};
inline constexpr int kModelInputs = kMaxParams + 6;
inline constexpr int kSampleOutputs = 7;

struct OtherFn {
    const char* name;
    int inputs, outputs;
    RunFn run;
};

struct IsaFns {
    const char* name;
    const ModelFns* models; // in the order of shading/models.def
    int model_count;
    const OtherFn* others;
    int other_count;
};

const IsaFns& oracle_fns();
const std::vector<IsaFns>& float_fns(); // scalar first, then what this processor runs
const IsaFns& fast_fns();               // one of these

const OtherFn& other(const IsaFns& isa, const char* name);

// The function `name` at one point.
std::vector<double> call(const IsaFns& isa, const char* name, const std::vector<double>& in);

} // namespace burnish::test

namespace burnish {
BN_DECLARE_FNS(test::IsaFns);
} // namespace burnish
