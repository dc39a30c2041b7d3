// Makes all mip levels of a material with a cascade.
#pragma once
#include <functional>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mipnet/texels.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish::mipnet {

struct TexelRows { // level 0, read in parts
    int width, height;
    std::function<void(int first, int count, Texels& to)> rows; // writes `count` rows to a matching `to`; called by several threads
};

// Makes all levels from 1 on. Sides are halved and rounded down, at least 1. A texel depends on its four texels and on the sixteen below,
// so nothing crosses a border, for any wrap mode. If a side is odd or 1, the level below is first resampled to twice the side, and the
// next one to four times, by area, in closed form. Level 0 is made valid and read in bands of rows, unless one of its sides is not a
// multiple of 4. Gives equal bytes for all threads and instruction sets.
std::vector<Texels> net_levels(const TexelRows& level0, const Weights& weights, const Jobs& jobs, Isa isa = best_isa());

// Makes all levels from a complete level 0, which comes first and is made valid.
std::vector<Texels> net_pyramid(const Texels& level0, const Weights& weights, const Jobs& jobs, Isa isa = best_isa());

} // namespace burnish::mipnet
