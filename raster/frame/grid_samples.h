// The samples that a technique's frame brings: n x n of filtered importance sampling, or a Hammersley set for as_mc.
#pragma once
#include <vector>

#include "raster/frame/frame.h"
#include "shading/lang/tables.h"

namespace burnish {

// traits: of the technique. n = floor(sqrt(samples)): Gaussian slopes (Beckmann) or GGX; of kPhongGrid all samples, the first of which is
// the normal. None where a technique brings none.
std::vector<GridSample> grid_samples(int samples, Sampling sampling, int traits);

} // namespace burnish
