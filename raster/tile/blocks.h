// Deferred writes of 8x8 pixel blocks. A block that is empty or fully covered by one triangle needs no clear, depth test or read.
#pragma once
#include "core/simd/lanes.h"
#include "raster/tile/tile_types.h"
#include "shading/kernels/depth_plane.k.h"
#include "shading/lang/lang.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr int kVectors = kBlockPixels / kLanes; // registers per block; a register holds kLanes pixels in row-major order
inline constexpr std::uint32_t kAllLanes = (1u << kLanes) - 1;

// Pixel offsets inside a block, by lane.
struct BlockLanes {
    integer x16, y16; // of the first register, 1/16 pixel
    real x, y;        // pixels
};
BN_INLINE BlockLanes block_lanes()
{
    const integer x = iota() & int_lit(7), y = shr(iota(), 3);
    return {shl(x, 4), shl(y, 4), to_real(x), to_real(y)};
}

// Returns the depth difference between a sample and its pixel's corner.
BN_INLINE real sample_depth_step(const FrameParams& f, real dz_x, real dz_y, int sample)
{
    const real to_pixels = splat(1.0f / 16);
    const real x = to_real(load_int(f.pattern.x16 + sample)) * to_pixels, y = to_real(load_int(f.pattern.y16 + sample)) * to_pixels;
    return depth_change(dz_x, dz_y, x, y);
}

// Greatest and least depth of a plane in a block, rounding included, within the triangle.
struct DepthBounds {
    float nearest, farthest;
};
BN_INLINE DepthBounds depth_bounds(const BlockPlane& p)
{
    const float ax = p.dz_x < 0.0f ? -p.dz_x : p.dz_x, ay = p.dz_y < 0.0f ? -p.dz_y : p.dz_y;
    const float size = p.z < 0.0f ? -p.z : p.z, slack = 1e-5f * (size + (ax + ay) * kBlock); // far above rounding errors
    const float middle = p.z + (p.dz_x + p.dz_y) * (0.5f * kBlock), reach = (ax + ay) * (0.5f * kBlock);
    const float nearest = middle + reach + slack, farthest = middle - reach - slack;
    return {nearest < p.z_max ? nearest : p.z_max, farthest > p.z_min ? farthest : p.z_min};
}

BN_INLINE void empty_blocks(int count, TileScratch& s)
{
    for (int block = 0; block < count; ++block) {
        s.block_far[block] = 0.0f;
        s.block_dirty[block] = 0;
        s.block_state[block] = BlockState::empty;
    }
}

// Stores a triangle that covers the whole block and hides its contents.
BN_INLINE void take_block(const BlockPlane& plane, float farthest, int block, TileScratch& s)
{
    s.block_plane[block] = plane;
    s.block_far[block] = farthest;
    s.block_dirty[block] = 0;
    s.block_state[block] = BlockState::whole;
}

// Writes the depths and ids of a deferred block to memory, and marks the block as drawn.
BN_STAGE void write_block(const FrameParams& f, int block, TileScratch& s)
{
    float* depth = s.depth + block * f.msaa * kBlockPixels;
    std::int32_t* ids = reinterpret_cast<std::int32_t*>(s.ids) + block * f.msaa * kBlockPixels;
    const bool whole = s.block_state[block] == BlockState::whole;
    s.block_state[block] = BlockState::drawn;
    // Clear an empty block
    if (!whole) {
        for (int i = 0; i < f.msaa * kBlockPixels; i += kLanes) {
            store(depth + i, lit(0.0));
            store_int(ids + i, int_lit(-1));
        }
        return;
    }
    // Fill the block from one triangle's plane
    const BlockPlane& p = s.block_plane[block];
    const BlockLanes lanes = block_lanes();
    const real dz_x = splat(p.dz_x), dz_y = splat(p.dz_y), z_min = splat(p.z_min), z_max = splat(p.z_max);
    const integer id = int_lit(static_cast<std::int32_t>(p.id));
    float sample_z[kMaxSamples];
    for (int k = 0; k < f.msaa; k += kLanes)
        store(sample_z + k, sample_depth_step(f, dz_x, dz_y, k));
    for (int v = 0; v < kVectors; ++v) {
        const real x = lanes.x + splat(static_cast<float>(v * kLanes & 7)), y = lanes.y + splat(static_cast<float>(v * kLanes >> 3));
        const real z = splat(p.z) + depth_change(dz_x, dz_y, x, y);
        for (int k = 0; k < f.msaa; ++k) {
            store(depth + k * kBlockPixels + v * kLanes, depth_at_sample(z, splat(sample_z[k]), z_min, z_max));
            store_int(ids + k * kBlockPixels + v * kLanes, id);
        }
    }
}

BN_INLINE void write_all_blocks(const FrameParams& f, TileScratch& s)
{
    const int count = (f.tile_size / kBlock) * (f.tile_size / kBlock);
    for (int block = 0; block < count; ++block)
        if (s.block_state[block] != BlockState::drawn)
            write_block(f, block, s);
}

} // namespace BN_ISA_NS
} // namespace burnish
