// The lane harness: kernels under test as functions over arrays of doubles. Kernels are compiled once for each instruction set and for the
// double oracle. A test program lists its kernels in kernels.def, which its kernels.isa.cpp includes (run_lanes.h). bn_lane_kernels()
// builds them.
#pragma once
#include <cstdint>
#include <vector>

#include "core/simd/fns.h"

namespace burnish::test {

// Texels for kernels that fetch: a cube, a texture of halves or a table. A kernel reads the fields that it needs.
struct TexelView {
    const std::uint16_t* texels = nullptr;
    const float* pairs = nullptr; // of a table with pairs of floats
    int size = 0, levels = 1;     // of a cube or a table
    int level = 0;
    const std::int32_t* offset = nullptr; // of a texture, by level
    const float *level_width = nullptr, *level_height = nullptr;
    int wrap_s = 0, wrap_t = 0, nearest = 0, max_taps = 1;
};

// Runs n points. Argument i of point k is in[i * n + k], result j is out[j * n + k]. Float versions round their arguments to float.
struct Kernel {
    const char* name;
    int inputs, outputs;
    void (*run)(const TexelView& t, int n, const double* in, double* out);
};

struct IsaFns {
    const char* name; // of the instruction set
    const Kernel* kernels;
    int count;
};

const IsaFns& oracle_fns();
const std::vector<IsaFns>& float_fns(); // scalar first, then those that this processor runs
const std::vector<IsaFns>& all_fns();   // float_fns(), then the oracle
const IsaFns& fast_fns();               // one of float_fns()

const Kernel& kernel(const IsaFns& isa, const char* name);
std::vector<double> run(const Kernel& kernel, const std::vector<double>& in, const TexelView& t = {});

// Runs the kernel `name` at all points of `in`.
std::vector<double> call(const IsaFns& isa, const char* name, const std::vector<double>& in, const TexelView& t = {});

} // namespace burnish::test

namespace burnish {
BN_DECLARE_FNS(test::IsaFns);
} // namespace burnish
