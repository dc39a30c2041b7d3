// Loops over lanes that the benchmarks time: the processor's own limits, and single lane operations. One table an instruction set.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"

namespace burnish {

struct LaneLoopInput {           // arrays of kLaneLoopCount
    const float *a, *b;          // a in [1, 2), b in [0.5, 1)
    const std::int32_t* index;   // a permutation
    const std::uint16_t* texels; // RGBA halves, kLaneLoopCount of them and a row more
    float* out;
};
inline constexpr int kLaneLoopCount = 1024; // everything stays in the first-level cache

struct LaneLoop {
    const char* name;
    void (*run)(const LaneLoopInput&); // the operation once for each element
};

struct LimitFns {
    int lanes;
    // steps times 12 independent multiplications and additions, not fused; the result keeps the compiler from leaving them out.
    float (*multiply_add)(int steps, float factor);
    const LaneLoop* loops;
    int loop_count;
};
inline constexpr int kMultiplyAddChains = 12;
BN_DECLARE_FNS(LimitFns);

} // namespace burnish
