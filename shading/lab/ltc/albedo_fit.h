// Fits albedos at a table's nodes, so that the interpolant is accurate between the nodes.
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/ltc/grid.h"

namespace burnish::ltc {

// Returns the albedos of the nodes' lobes.
std::vector<Albedo> albedos_of_nodes(const Grid& grid, Model model, const Jobs& jobs);

// Improves them by least squares: the relative error in nD and the error in fD, at `a_cell` lobes in each cell and, with less weight, at
// the nodes. The grid must not be round.
std::vector<Albedo> albedos_between_nodes(const Grid& grid, Model model, std::vector<Albedo> of_nodes, int a_cell, const Jobs& jobs);

} // namespace burnish::ltc
