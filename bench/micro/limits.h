// Lane loops for benchmarks: the processor's limits, and single lane operations. One table for each instruction set.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish {

struct LaneLoopInput {           // arrays of kLaneLoopCount
    const float *a, *b;          // a in [1, 2), b in [0.5, 1)
    const std::int32_t* index;   // a permutation
    const std::uint16_t* texels; // kLaneLoopCount RGBA half texels and one more row
    float* out;
};
inline constexpr int kLaneLoopCount = 1024; // all data stay in the first-level cache

struct LaneLoop {
    const char* name;
    void (*run)(const LaneLoopInput&); // runs the operation once for each element
};

struct LimitFns {
    int lanes;
    // Runs steps times 12 independent multiplications and additions, not fused. The result keeps the compiler from
    // removing them.
    float (*multiply_add)(int steps, float factor);
    const LaneLoop* loops;
    int loop_count;
};
inline constexpr int kMultiplyAddChains = 12;
BN_DECLARE_FNS(LimitFns);

} // namespace burnish
