// Sample grids for techniques: n x n samples for filtered importance sampling, or a lattice for as_mc.
#pragma once
#include <vector>

#include "raster/frame/frame.h"
#include "shading/bake/tables/phong.h"
#include "shading/lang/tables.h"

namespace burnish {

// Returns the technique's grid. traits: the technique's. n = floor(sqrt(samples)). Slopes are Gaussian (Beckmann) or follow GGX. Under
// kPhongGrid each sample is a block of kPhongBlock values, which holds four sets. A single sample is the normal. Empty if the technique
// needs no grid.
std::vector<GridSample> grid_samples(int samples, Sampling sampling, int traits);

// Returns the number of samples that a fragment takes.
int grid_count(const std::vector<GridSample>& grid, int traits);

// Appends one block per sample in the layout of as_mc.t.h: half vectors for four sets, and half the base 2 logarithm of their density.
void add_half_vectors(const std::vector<PhongHalfVector>& half_vectors, std::vector<GridSample>& to);

} // namespace burnish
