// All levels of a material by a cascade.
#pragma once
#include <functional>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mipnet/texels.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish::mipnet {

struct TexelRows { // level 0, as far as it is wanted at once
    int width, height;
    std::function<void(int first, int count, Texels& to)> rows; // writes `count` rows, which `to` has; by several threads
};

// All levels from 1 on; each side is half of that before, rounded down, at least 1. A texel is made of the four texels that it covers and
// of the sixteen below them, so nothing crosses a border, whatever the wrap. Where a side is odd, or 1, the level below is first brought to
// twice the side (and the one below it to four times) by area, in closed form. Level 0, made valid, is looked at in bands of rows, unless
// one of its sides is no multiple of 4. The same bytes for all threads and instruction sets.
std::vector<Texels> net_levels(const TexelRows& level0, const Weights& weights, const Jobs& jobs, Isa isa = best_isa());

// The same of a level 0 that is there: the first one, made valid.
std::vector<Texels> net_pyramid(const Texels& level0, const Weights& weights, const Jobs& jobs, Isa isa = best_isa());

} // namespace burnish::mipnet
