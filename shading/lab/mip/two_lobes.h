// Levels with two lobes per texel. Crossing grain below a texel makes crossed highlights, which one ellipse cannot show. Frames draw one
// lobe; these pairs measure the gain from two.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/mip_error.h"

namespace burnish {

struct LobePairs { // levels from 1 on, each lobe with half the light
    std::vector<mipnet::Texels> first, second;
};

// Optimises pairs of lobes as optimised_levels() does. Starts from several pairs about `ones`, the levels 1, 2, ... with one lobe per
// texel. The two lobes move by turns, each against the remainder that the other leaves. No texel ends worse than with one lobe, by these
// directions.
LobePairs optimised_pairs(const mipnet::Texels& level0, const std::vector<mipnet::Texels>& ones, const MipErrorSurface& surface,
                          const Jobs& jobs);

} // namespace burnish
