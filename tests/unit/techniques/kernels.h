// Technique kernels of every instruction set and of the double oracle, as tables of plain functions over arrays of doubles.
#pragma once
#include <vector>

#include "core/simd/fns.h"

namespace burnish::test {

struct TechniqueKernels {
    const char* name;
    // in: ox oy oz sigma_x sigma_y k beta count; out: t_near t_far e0xyz e1xyz radius length width
    void (*major_axis)(const double in[8], double out[11]);
    // in: e0xyz e1xyz oxyz s; out: direction xyz
    void (*major_axis_direction)(const double in[10], double out[3]);
    // in: as major_axis, count being the limit; out: cells, and how many samples they hold
    void (*grain_count)(const double in[8], double out[2]);
    // in: oxyz sigma_x sigma_y limit; out: along xy, width, count, whole cells; then at c = in[6]: direction xyz, weight, radius
    void (*lobe_line)(const double in[7], double out[10]);
    // in: vxyz sigma_u sigma_v in the frame u = x, v = y, n = z; out: direction xyz lod
    void (*bent_normal)(const double in[5], double out[4]);
    // in: normal xyz, tangent xyz, handedness, tangent-space normal; out: n t b, xyz each
    void (*mapped_frame)(const double in[10], double out[9]);
};

const TechniqueKernels& oracle_kernels();
std::vector<TechniqueKernels> float_kernels(); // scalar first, then what this processor can run

} // namespace burnish::test

namespace burnish {
BN_DECLARE_FNS(test::TechniqueKernels);
} // namespace burnish
