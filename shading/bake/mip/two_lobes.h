// Two lobes a texel, where one is too few: grain that crosses below a texel makes a cross of highlights, which no ellipse is. Frames draw
// one lobe; what two would be worth is measured with these.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/shown.h"

namespace burnish {

struct LobePairs { // levels from 1 on, each lobe of half the light
    std::vector<mipnet::Texels> first, second;
};

// By search, as taught_levels(): from several pairs about the lobes `ones`, levels 1, 2, ... of one lobe a texel, each of the two is moved
// by turns beside what the other reflects. No texel ends worse than its one lobe is, by these directions.
LobePairs taught_pairs(const mipnet::Texels& level0, const std::vector<mipnet::Texels>& ones, const ShownSurface& surface,
                       const Jobs& jobs);

} // namespace burnish
