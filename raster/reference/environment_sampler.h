// Samples directions of the environment in proportion to luminance. The table has one cell per texel in the specular cube's level 0, whose
// radiance is integrated. The descent through a quadtree keeps nearby random numbers nearby (Clarberg et al. 2005, "Wavelet importance
// sampling"), so stratification survives.
#pragma once
#include "core/base/column.h"
#include "core/jobs/jobs.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

inline constexpr int kMaxSamplerLevels = 13;

// The table for lane code, see light_sampling.h. Level l has 2^l nodes per side. Node (face, x, y) lies at offset[l] + (face 2^l + y) 2^l
// + x, and the two columns of its children at 2 (offset[l] + (face 2^l + y) 2^l + x) and + 1.
struct EnvironmentSamplerView {
    const float* left;    // by node: probability of its left half
    const float* upper;   // by column of a node: probability of its upper child
    const float* density; // by texel [face][row][column]: probability over area on the face, whose area is 4
    float face_end[6];    // cumulative probabilities of the faces
    std::int32_t offset[kMaxSamplerLevels];
    std::int32_t levels; // log2(size)
    std::int32_t size;
};

struct EnvironmentSampler {
    Column<float> left, upper, density;
    EnvironmentSamplerView view; // points into the columns
    double mean_luminance = 0.0; // over the sphere
};

EnvironmentSampler make_environment_sampler(const CubeMap& cube, const Jobs& jobs);

} // namespace burnish
