// The n x n samples of filtered importance sampling.
#pragma once
#include <vector>

#include "shading/lang/tables.h"

namespace burnish {

// n = floor(sqrt(samples)): Gaussian slopes (Beckmann) or GGX.
std::vector<GridSample> grid_samples(int samples, bool ggx);

} // namespace burnish
