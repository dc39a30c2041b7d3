// Error of mipmaps against the reference: level 0 lit at full resolution, its linear radiance averaged.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/mip_error.h"
#include "shading/bake/mipnet/net.h"
#include "shading/bake/mipnet/texels.h"

namespace burnish::mipnet {

inline constexpr int kEvaluatedLevels = 5; // levels 1 to 5, with FLIP for at least 16 texels a side

// Returns the mean L1 over levels 1 to 5, under 24 pairs for each 32 x 32 texel tile. The laboratory judges a
// choice made by these errors with other pairs. pyramids: of one square level 0, whose side is a multiple of 32. metal: see compare_on().
std::vector<double> mean_l1(const std::vector<std::vector<Texels>>& pyramids, Lobe lobe, bool metal, const Jobs& jobs);

// Returns levels 1 to 5 of pyramids that start with level 0.
std::vector<std::vector<Texels>> evaluated_levels(const std::vector<std::vector<Texels>>& pyramids);

} // namespace burnish::mipnet
