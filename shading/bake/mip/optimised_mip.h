// Mip levels by optimisation. Each texel's lobe moves until, lit, it looks like the average of level 0 under it. The result is about the
// best that one lobe per texel can reach. MIPNet (Gauthier et al. 2022) compares with AutoLoD, which works alike.
#pragma once
#include <functional>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/mip/mip_error.h"

namespace burnish {

// Progress: finished texels and their total. Called by one thread at a time.
using OptimisedTexels = std::function<void(std::size_t done, std::size_t all)>;

// Optimises levels 1, 2, ... with the starts' number and sizes. Each texel begins at its best start. The light is 256 pairs of directions
// to light and eye, drawn as in training. The optimiser takes 120 Adam steps with 32 pairs each. The loss compares tonemapped radiance: x
// / (1 + x) encoded as sRGB. No texel ends worse than its best start under these pairs. The bytes depend neither on threads nor on the
// instruction set. level0: valid texels (make_valid()).
std::vector<mipnet::Texels> optimised_levels(const mipnet::Texels& level0, const std::vector<std::vector<mipnet::Texels>>& starts,
                                             const MipErrorSurface& surface, const Jobs& jobs, const OptimisedTexels& advance = {});

} // namespace burnish
