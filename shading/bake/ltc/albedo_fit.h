// Albedos of a table's nodes, of which the interpolant is near, not the nodes alone.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/grid.h"

namespace burnish::ltc {

// Of each node's own lobe.
std::vector<Albedo> albedos_of_nodes(const Grid& grid, Model model, const Jobs& jobs);

// From those, by least squares of the relative error of nD and of the error of fD at `a_cell` lobes in each cell and, of less weight, at
// the nodes. Of grids that are not round.
std::vector<Albedo> albedos_between_nodes(const Grid& grid, Model model, std::vector<Albedo> of_nodes, int a_cell, const Jobs& jobs);

} // namespace burnish::ltc
