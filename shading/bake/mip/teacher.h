// Levels by search: each texel's lobe is moved until, lit, it looks as level 0 below it does. What the best filter of one lobe a texel can
// reach, about: MIPNet (Gauthier et al. 2022) compares with AutoLoD, which works alike.
#pragma once
#include <functional>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/shown.h"

namespace burnish {

// Texels done and all there are, of one caller at a time.
using TaughtTexels = std::function<void(std::size_t done, std::size_t all)>;

// Levels 1, 2, ... as many and as large as those of each start; of them, texel by texel, the best is where the search begins. Under 256
// pairs of directions to light and eye as nets are trained with, 120 steps of Adam of 32 pairs each, on differences of what is shown: x /
// (1 + x) encoded as sRGB. No texel ends worse than the best start is, by these pairs. The bytes depend neither on threads nor on the
// instruction set. level0: valid texels (make_valid()).
std::vector<mipnet::Texels> taught_levels(const mipnet::Texels& level0, const std::vector<std::vector<mipnet::Texels>>& starts,
                                          const ShownSurface& surface, const Jobs& jobs, const TaughtTexels& advance = {});

} // namespace burnish
