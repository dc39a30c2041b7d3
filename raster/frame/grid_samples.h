// The samples that a technique's frame brings: n x n of filtered importance sampling, or a lattice for as_mc.
#pragma once
#include <vector>

#include "raster/frame/frame.h"
#include "shading/bake/tables/phong.h"
#include "shading/lang/tables.h"

namespace burnish {

// traits: of the technique. n = floor(sqrt(samples)): Gaussian slopes (Beckmann) or GGX; of kPhongGrid a block of kPhongBlock a
// sample, which holds it of four sets; one sample is the normal. None where a technique brings none.
std::vector<GridSample> grid_samples(int samples, Sampling sampling, int traits);

// How many of them a fragment takes.
int grid_count(const std::vector<GridSample>& grid, int traits);

// A block a sample, as as_mc.t.h has them: half vectors of four sets, and half the logarithm to base 2 of their density.
void add_half_vectors(const std::vector<PhongHalfVector>& half_vectors, std::vector<GridSample>& to);

} // namespace burnish
