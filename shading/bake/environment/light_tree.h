// The light of an environment as a tree: what is far from a lobe, measured by the lobe's width, is summed in large pieces, each at the one
// place that its light comes from (Barnes, Hut 1986; the place makes the sum exact to first order). A small sun then weighs what the lobe
// weighs there, however far it is and however large the piece that it lies in.
#pragma once
#include <cstddef>
#include <vector>

#include "core/jobs/jobs.h"
#include "shading/bake/bake_fns.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {

struct LightTree {
    const std::vector<CubeLevel>& boxes; // the finest first, each half of the one before, down to one texel a face
    // by level and texel from level 1 on, xyz: the unit direction that the texel's light comes from on the mean; level 0: empty, its
    // texels' light comes from their centres
    std::vector<std::vector<float>> places;
};
// boxes must outlive the tree.
LightTree make_light_tree(const std::vector<CubeLevel>& boxes, const Jobs& jobs);

// A square of texels that share their pieces. u, v: [-1,1], of its corners.
struct PrefilterBlock {
    int face;
    double u0, v0, u1, v1;
};
// The pieces for lobes of width alpha (GGX, (0,1]) around the directions of a block: no piece is larger than `opening` times its distance
// or the lobe's width. Those below every texel's horizon are left out. Replaces what `terms` held.
void gather_terms(const LightTree& tree, const PrefilterBlock& block, double alpha, double opening, std::vector<PrefilterTerm>& terms);

} // namespace burnish
