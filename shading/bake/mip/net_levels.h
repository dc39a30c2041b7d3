// Mip levels by a net (shading/bake/mipnet), and a check that the net is good enough for a material.
#pragma once
#include "core/jobs/jobs.h"
#include "shading/bake/mip/fallback.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/source.h"

namespace burnish {

// Fills to.levels and to.net; the caller has filled the rest. Nothing crosses a border, for any wrap mode: a texel reads only its
// footprint.
void put_net_levels(const MipRows& level0, const mipnet::Weights& net, const Jobs& jobs, MipLevels& to);

// Fills levels by optimisation, for filter teacher. The search starts from the net's levels and from means.
void put_optimised_levels(const MipRows& level0, const mipnet::Weights& net, const MipHelp& help, const Jobs& jobs, MipLevels& to);

// Compares the net with closed forms on a material. metal: the material reflects as a metal. kappa: of filter kappa.
mipnet::Comparison compare_net(const MipSource& source, const mipnet::Weights& net, float kappa, bool metal, const Jobs& jobs);

} // namespace burnish
