// The environment's light as a tree (Barnes, Hut 1986). Light far from a lobe, relative to the lobe's width, is summed in large pieces.
// Each piece sits at its light's mean direction, which makes the sum exact to first order. So a small sun gets the lobe's weight at the
// sun's place, even from a large piece far away.
#pragma once
#include <cstddef>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/bake_fns.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {

struct LightTree {
    const std::vector<CubeLevel>& boxes; // finest first, each half as large, down to one texel per face
    // By level from 1 on, then texel, xyz: the texel light's mean direction, unit. Level 0 is empty: its texels' light comes from their
    // centres.
    std::vector<std::vector<float>> places;
};
// Builds the tree. boxes must outlive it.
LightTree make_light_tree(const std::vector<CubeLevel>& boxes, const Jobs& jobs);

// A square of texels that share their pieces. u, v: [-1,1], at its corners.
struct PrefilterBlock {
    int face;
    double u0, v0, u1, v1;
};
// Gathers light pieces for lobes of width alpha (GGX, (0,1]) around a block's directions. No piece is larger than `opening` times its
// distance or the lobe's width. Leaves out pieces below every texel's horizon. Replaces the contents of `terms`.
void gather_terms(const LightTree& tree, const PrefilterBlock& block, double alpha, double opening, std::vector<PrefilterTerm>& terms);

} // namespace burnish
