// Directions of the environment in proportion to its luminance: a table with one cell a texel of the specular cube's level 0, which is
// the radiance that is integrated. Descending a quadtree keeps neighbouring random numbers neighbours (Clarberg et al. 2005, "Wavelet
// importance sampling"), so the points' stratification survives.
#pragma once
#include "core/base/column.h"
#include "core/jobs/jobs.h"
#include "shading/bake/environment/environment.h"

namespace burnish {

inline constexpr int kMaxSamplerLevels = 13;

// What lanes read, see light_sampling.h. Node (face, x, y) of level l, which has 2^l nodes a side, lies at offset[l] + (face 2^l + y)
// 2^l + x; the two columns of its children at 2 (offset[l] + (face 2^l + y) 2^l + x) and + 1.
struct EnvironmentSamplerView {
    const float* left;    // by node: share of its left half
    const float* upper;   // by column of a node: share of its upper child
    const float* density; // by texel [face][row][column]: probability over area on the face, whose area is 4
    float face_end[6];    // cumulative shares of the faces
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
