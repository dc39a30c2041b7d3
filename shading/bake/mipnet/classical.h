// Mipmaps of normals and widths in closed form, in double. Nets are measured against them, and odd sizes use them.
#pragma once
#include <vector>

#include "shading/bake/mipnet/texels.h"

namespace burnish::mipnet {

// baseline: averages normals, renormalised, and widths. kappa: averages squared widths in the mean normal's frame, plus kappa times the
// covariance of normals. Each level comes from the level before, as with nets; bake/mip/filter.h has these and other filters from level 0.
enum class Method { baseline, kappa };

// Resamples a level to a smaller size: each texel averages its footprint by area. Nothing crosses a border.
Texels shrunk(const Texels& from, int width, int height, Method method, double kappa);

// Makes all levels, the first one `level0`. Sides are halved and rounded down, at least 1.
std::vector<Texels> classical_pyramid(const Texels& level0, Method method, double kappa = 0.5);

int side_of_level(int side, int level);

} // namespace burnish::mipnet
