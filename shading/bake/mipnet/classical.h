// Mipmaps of normals and widths in closed form, in double: what nets are measured against, and what odd sizes are gathered with.
#pragma once
#include <vector>

#include "shading/bake/mipnet/texels.h"

namespace burnish::mipnet {

// baseline: normals averaged and made unit again, widths averaged. kappa: widths squared averaged in the frame of the mean normal, + kappa
// times the covariance of normals. Level from level, as nets go; bake/mip/filter.h has those and others from level 0.
enum class Method { baseline, kappa };

// A level of any size from one of any size: each texel takes what lies below it, by its area. Nothing crosses a border.
Texels shrunk(const Texels& from, int width, int height, Method method, double kappa);

// All levels, the first one `level0`, each side half of that before, rounded down, at least 1.
std::vector<Texels> classical_pyramid(const Texels& level0, Method method, double kappa = 0.5);

int side_of_level(int side, int level);

} // namespace burnish::mipnet
