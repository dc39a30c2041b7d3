// Levels by a net (shading/bake/mipnet), and whether it is good enough for a material.
#pragma once
#include "core/jobs/jobs.h"
#include "shading/bake/mip/fallback.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/levels.h"
#include "shading/bake/mip/source.h"

namespace burnish {

// Writes to.levels and to.net; the rest of `to` is filled in. Nothing crosses a border, whatever the wrap: a texel is made of what it
// covers.
void put_net_levels(const MipRows& level0, const mipnet::Weights& net, const Jobs& jobs, MipLevels& to);

// The same of filter teacher, which begins with the net's levels and those of means.
void put_taught_levels(const MipRows& level0, const mipnet::Weights& net, const MipHelp& help, const Jobs& jobs, MipLevels& to);

// metal: whether the material reflects as one. kappa: of the closed form beside plain means.
mipnet::Comparison compare_net(const MipSource& source, const mipnet::Weights& net, float kappa, bool metal, const Jobs& jobs);

} // namespace burnish
