// Depth peeling for blended surfaces: at each sample, finds the nearest triangle behind the last layer and before the solid surface. At
// equal depths the triangle that is drawn first lies in front.
#pragma once
#include "raster/tile/raster.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct PeelBlock { // the last layer in one block
    const float* depth;
    const std::int32_t* id;
};
struct PeelBlocks {
    static constexpr bool kTests = true;
    const FrameParams& f;
    const PeelScratch& peel;
    PeelBlock operator()(int bx, int by) const
    {
        const int at = (by * (f.tile_size / kBlock) + bx) * f.msaa * kBlockPixels;
        return {peel.depth + at, peel.id + at};
    }
};

// Tests and writes depth for one block of a blended triangle.
template <int kEdges, bool kAnyOrder>
BN_INLINE bool cover_block(const FrameParams& f, const TileTriangle& t, const EdgeLanes& of_triangle, const BlockEdges& e,
                           const BlockLanes& lanes, float z_corner, int row0, int row1, std::uint32_t id, float* depth, std::uint32_t* ids,
                           const PeelBlock& before)
{
    const real z_min = splat(t.z_min), z_max = splat(t.z_max), dz_x = splat(t.dz_x), dz_y = splat(t.dz_y);
    const integer lane_id = int_lit(static_cast<std::int32_t>(id)), zero = int_lit(0);
    const RegisterRange range = registers_of_rows(row0, row1);
    bool wrote = false;
    RegisterEdges<kEdges> edges = edges_of_register<kEdges>(t, of_triangle, e, range.first);
    for (int v = range.first; v <= range.last; ++v, next_register<kEdges>(t, of_triangle, e, v - 1, edges)) {
        const real z = depths_of_register(lanes, splat(z_corner), dz_x, dz_y, v);
        for (int s = 0; s < f.msaa; ++s) {
            const int at = s * kBlockPixels + v * kLanes;
            std::int32_t* const to = reinterpret_cast<std::int32_t*>(ids) + at;
            integer side = zero;
            // Pass samples inside the triangle, in front of others, behind the last layer
            for (int i = 0; i < kEdges; ++i)
                side = side | (edges.at[i] + int_lit(t.sample_step[e.edge[i]][s]));
            const real zs = depth_at_sample(z, splat(t.sample_z[s]), z_min, z_max), old = load(depth + at), last = load(before.depth + at);
            const integer old_id = load_int(to);
            const mask nearest = either(zs > old, both(zs == old, either(old_id < zero, lane_id < old_id)));
            const mask behind = either(zs < last, both(zs == last, lane_id > load_int(before.id + at)));
            const mask pass = both(side >= zero, both(nearest, behind));
            store(depth + at, select(pass, zs, old));
            store_int(to, select(pass, lane_id, old_id));
            wrote = any(pass) || wrote;
        }
    }
    return wrote;
}

// Clears a layer: its samples start at the solid depths. Samples and blocks without a further layer accept no triangle.
BN_INLINE void begin_layer(const FrameParams& f, const TileScratch& solid, TileScratch& layer)
{
    const int blocks = (f.tile_size / kBlock) * (f.tile_size / kBlock), samples = f.msaa * kBlockPixels;
    layer.only_material = kNoMaterial;
    for (int block = 0; block < blocks; ++block) {
        const bool done = solid.peel->done[block];
        layer.block_state[block] = done ? BlockState::empty : BlockState::drawn;
        layer.block_far[block] = done ? 2.0f : 0.0f; // a lower bound beyond any triangle's depth
        layer.block_dirty[block] = 0;
        for (int i = block * samples; i < (block + 1) * samples && !done; i += kLanes) {
            store(layer.depth + i, select(load(solid.peel->depth + i) >= lit(0.0), load(solid.depth + i), lit(2.0)));
            store_int(reinterpret_cast<std::int32_t*>(layer.ids) + i, int_lit(-1));
        }
    }
}

// Returns the farthest depth among all samples of a layer.
BN_INLINE float farthest_of_layer(const FrameParams& f, TileScratch& layer)
{
    const int blocks = (f.tile_size / kBlock) * (f.tile_size / kBlock), samples = f.msaa * kBlockPixels;
    float farthest = 2.0f;
    for (int block = 0; block < blocks; ++block) {
        if (layer.block_dirty[block] > 0) {
            layer.block_far[block] = farthest_depth(f, layer.depth + block * samples);
            layer.block_dirty[block] = 0;
        }
        farthest = layer.block_far[block] < farthest ? layer.block_far[block] : farthest;
    }
    return farthest;
}

} // namespace BN_ISA_NS
} // namespace burnish
