// All levels of a material by a cascade.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mipnet/texels.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish::mipnet {

// The first one is level 0 made valid; each side is half of that before, rounded down, at least 1. A texel is made of the four texels that
// it covers and of the sixteen below them, so nothing crosses a border, whatever the wrap. Where a side is odd, or 1, the level below is
// first brought to twice the side (and the one below it to four times) by area, in closed form. The same bytes for all threads and
// instruction sets.
std::vector<Texels> net_pyramid(const Texels& level0, const Weights& weights, const Jobs& jobs, Isa isa = best_isa());

} // namespace burnish::mipnet
