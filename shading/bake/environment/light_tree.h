// The environment's light as a tree (Barnes, Hut 1986). Light far from a lobe, relative to the lobe's width, is summed in large pieces.
// Each piece sits at its light's mean direction, which makes the sum exact to first order. So a small sun gets the lobe's weight at the
// sun's place, even from a large piece far away.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"
#include "shading/bake/bake_fns.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {

struct LightTree {
    const std::vector<CubeLevel>& boxes; // finest first, each half as large, down to one texel per face
    // By level, in the order of LightLevel. Places are the mean directions of the texels' light, unit. Light of level 0 comes from the
    // texels' centres.
    std::vector<std::vector<double>> angles;
    std::vector<std::vector<float>> places;
    std::vector<LightLevel> levels() const;
};
// Builds the tree. boxes must outlive it. Level 0 of more than `most_placed` texels along an
// edge stores no places: a walk then finds them anew, in less memory.
LightTree make_light_tree(const std::vector<CubeLevel>& boxes, const Jobs& jobs, int most_placed = 1024);

// Squares of blocks on a face. The texels of a block share their pieces. Blocks: `along` x `along` of side `side`, the first at (u0, v0);
// u, v: [-1,1].
struct BlockSquare {
    int face, along;
    double u0, v0, side;
};
// Memory for gathering, to be kept by a thread.
struct GatherScratch {
    struct List {
        std::vector<PrefilterTerm> terms;
        std::vector<GatherMark> marks;
    };
    std::vector<List> lists; // by depth
};
// Gathers light pieces for lobes of width alpha (GGX, (0,1]) around each block's directions, and calls use(x, y, terms) for block (x, y) of
// the square. No piece is larger than `opening` times its distance or the lobe's width. Pieces below every texel's horizon are left out.
// Blocks share a walk as long as they open the same pieces. along: a power of two.
void gather_terms(const std::vector<LightLevel>& levels, const BlockSquare& square, double alpha, double opening, GatherScratch& scratch,
                  const std::function<void(int, int, std::span<const PrefilterTerm>)>& use, const LightTreeFns& fns = pick<LightTreeFns>());

} // namespace burnish
