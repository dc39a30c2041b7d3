// Lane code for rays through a tree: plain data, shared by baseline code and instruction-set objects.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"
#include "raster/rays/ray_scene.h"

namespace burnish {

inline constexpr int kLeafTriangles = 4, kDeepestTree = 96; // levels

// The bounds of two children. A child with triangles is a leaf.
struct alignas(64) RayNode {
    float low[2][3], high[2][3];
    std::uint32_t first[2]; // a leaf's first triangle, else the child's node
    std::uint16_t count[2]; // a leaf's triangles, else 0
    std::uint32_t axis;     // that divides the children: 0, 1 or 2
};

struct RayTriangle {
    float corner[3][3];
    std::uint32_t id; // global
    std::uint32_t single_sided;
};

struct RayTreeView {
    const RayNode* nodes;
    const RayTriangle* triangles;
    bool any;
};

struct TraceFns { // one table per instruction set
    // Traces a packet's valid rays. Nearer hits replace those in the packet. Of hits at one distance the lowest id counts.
    void (*trace)(const RayTreeView&, RayPacket&, RayKind);
};
BN_DECLARE_FNS(TraceFns);

} // namespace burnish
