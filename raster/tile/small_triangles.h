// Small triangles, one per lane. All lanes walk their bounding boxes' pixels together. Depths equal those in raster.h, so pictures do not
// show which code drew a triangle.
#pragma once
#include "raster/tile/lane_triangles.h"
#include "raster/tile/raster.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Queue of covered samples for the depth test. The test is scalar, because triangles in a register may share a sample.
struct SampleQueue {
    static constexpr int kRoom = 512, kLaneShift = 16;
    int count;
    std::int32_t depth[kRoom]; // bits of a float
    std::int32_t where[kRoom]; // index into the tile's samples | lane << kLaneShift
};
static_assert(kMaxTileSize * kMaxTileSize * kMaxSamples <= 1 << SampleQueue::kLaneShift && SampleQueue::kRoom >= 2 * kMaxSamples * kLanes);

// Tests and writes the queued samples. The nearest sample wins; at equal depths the first triangle in the list wins. first: the triangle
// in lane 0.
BN_INLINE void draw_queue(SampleQueue& q, std::uint32_t first, TileScratch& s)
{
    for (int i = 0; i < q.count; ++i) {
        const std::uint32_t where = static_cast<std::uint32_t>(q.where[i]), at = where & ((1u << SampleQueue::kLaneShift) - 1);
        const std::int32_t id = static_cast<std::int32_t>(first + (where >> SampleQueue::kLaneShift));
        const float z = __builtin_bit_cast(float, q.depth[i]);
        if (z > s.depth[at] || (z == s.depth[at] && id < static_cast<std::int32_t>(s.ids[at]))) {
            s.depth[at] = z;
            s.ids[at] = static_cast<std::uint32_t>(id);
        }
    }
    q.count = 0;
}

// Returns the lanes with triangles at most a block wide and high.
BN_INLINE mask small_triangles(const LaneTriangles& t)
{
    const integer side = int_lit(kBlock * kSubpixel);
    return both(max3(t.x) - min3(t.x) <= side, max3(t.y) - min3(t.y) <= side);
}

struct DepthPlane { // TileTriangle's plane, by lane
    wide z, z_x, z_y;
    real dz_x, dz_y, z_min, z_max;
};

BN_INLINE DepthPlane depth_plane(const LaneTriangles& t)
{
    const wide x10 = to_wide(t.x[1] - t.x[0]), y10 = to_wide(t.y[1] - t.y[0]), x20 = to_wide(t.x[2] - t.x[0]),
               y20 = to_wide(t.y[2] - t.y[0]);
    const wide z0 = to_wide(t.z[0]), z10 = to_wide(t.z[1]) - z0, z20 = to_wide(t.z[2]) - z0;
    DepthPlane p;
    p.z = z0;
    depth_slopes(x10, y10, x20, y20, z10, z20, p.z_x, p.z_y);
    p.dz_x = to_real(depth_slope_by_pixel(p.z_x)), p.dz_y = to_real(depth_slope_by_pixel(p.z_y));
    p.z_min = min(t.z[2], min(t.z[0], t.z[1])), p.z_max = max(t.z[2], max(t.z[0], t.z[1]));
    return p;
}

// Draws the triangles in `drawn`: opaque ones that small_triangles() returns. Their ids in the tile's list are `first` + lane. x0, y0: the
// tile's corner, pixels. The blocks' farthest depths are not updated.
BN_STAGE void raster_small_triangles(const FrameParams& f, const LaneTriangles& t, mask drawn, int x0, int y0, std::uint32_t first,
                                     TileScratch& s)
{
    // Find the pixels of the bounding boxes
    const int ox = x0 * kSubpixel - f.center_x, oy = y0 * kSubpixel - f.center_y;
    const integer zero = int_lit(0), last = int_lit(f.tile_size - 1), one = int_lit(1);
    const integer px0 = max(shr(min3(t.x) - int_lit(ox + f.pattern.max_x - kSubpixel + 1), 8), zero);
    const integer py0 = max(shr(min3(t.y) - int_lit(oy + f.pattern.max_y - kSubpixel + 1), 8), zero);
    const integer px1 = min(shr(max3(t.x) - int_lit(ox + f.pattern.min_x), 8), last);
    const integer py1 = min(shr(max3(t.y) - int_lit(oy + f.pattern.min_y), 8), last);
    drawn = both(drawn, both(px0 <= px1, py0 <= py1));
    if (none(drawn))
        return;

    // Set up edges at the boxes' first pixels
    integer edge[3], step_x[3], step_y[3], sample_step[3][kMaxSamples];
    for (int i = 0; i < 3; ++i) {
        const int p = i == 2 ? 0 : i + 1, q = i == 0 ? 2 : i - 1;
        const integer a = t.y[p] - t.y[q], b = t.x[q] - t.x[p];
        const integer at = a * (int_lit(ox) - t.x[p]) + b * (int_lit(oy) - t.y[p]);
        const mask top_left = either(a > zero, both(a == zero, b > zero));
        edge[i] = shr(at - select(top_left, zero, one), 4) + shl(a * px0 + b * py0, 4);
        step_x[i] = shl(a, 4), step_y[i] = shl(b, 4);
        for (int k = 0; k < f.msaa; ++k)
            sample_step[i][k] = a * int_lit(f.pattern.x16[k]) + b * int_lit(f.pattern.y16[k]);
    }

    // Set up depth planes
    const DepthPlane plane = depth_plane(t);
    real sample_z[kMaxSamples];
    for (int k = 0; k < f.msaa; ++k)
        sample_z[k] = depth_change(plane.dz_x, plane.dz_y, splat(static_cast<float>(f.pattern.x16[k]) * (1.0f / 16)),
                                   splat(static_cast<float>(f.pattern.y16[k]) * (1.0f / 16)));
    // Compute depth at the corners of the one to four blocks that the bounding box touches
    const integer block_x = shr(px0, 3), block_y = shr(py0, 3), side = int_lit(kBlock * kSubpixel);
    const integer from_x = int_lit(ox) - t.x[0] + block_x * side, from_y = int_lit(oy) - t.y[0] + block_y * side;
    const wide left_x = to_wide(from_x), right_x = to_wide(from_x + side), top_y = to_wide(from_y), bottom_y = to_wide(from_y + side);
    const auto corner_depth = [&](wide x, wide y) { return to_real(depth_at(plane.z, plane.z_x, plane.z_y, x, y)); };
    const real corner[2][2] = {{corner_depth(left_x, top_y), corner_depth(right_x, top_y)},
                               {corner_depth(left_x, bottom_y), corner_depth(right_x, bottom_y)}};

    // Walk all boxes pixel by pixel
    SampleQueue queue;
    queue.count = 0;
    const integer block_samples = int_lit(f.msaa * kBlockPixels), in_block = int_lit(kBlock - 1), blocks_x = int_lit(f.tile_size / kBlock);
    const integer lane_tag = shl(iota(), SampleQueue::kLaneShift);
    integer y = py0;
    for (mask rows = drawn; any(rows); y = y + one, rows = both(drawn, y <= py1)) {
        const mask upper = shr(y, 3) == block_y;
        const real left = select(upper, corner[0][0], corner[1][0]), right = select(upper, corner[0][1], corner[1][1]);
        const real row_y = to_real(y & in_block);
        const integer row_at = shr(y, 3) * blocks_x * block_samples + shl(y & in_block, 3);
        integer x = px0, at_x[3] = {edge[0], edge[1], edge[2]};
        for (mask pixels = rows; any(pixels); x = x + one, pixels = both(rows, x <= px1)) {
            const real z = select(shr(x, 3) == block_x, left, right) + depth_change(plane.dz_x, plane.dz_y, to_real(x & in_block), row_y);
            const integer at = row_at + shr(x, 3) * block_samples + (x & in_block);
            // Queue the covered samples
            for (int k = 0; k < f.msaa; ++k) {
                const integer outside = (at_x[0] + sample_step[0][k]) | (at_x[1] + sample_step[1][k]) | (at_x[2] + sample_step[2][k]);
                const mask covered = both(pixels, outside >= zero);
                const real depth = depth_at_sample(z, sample_z[k], plane.z_min, plane.z_max);
                compress_store_int(queue.depth + queue.count, bits_of(depth), covered);
                queue.count += compress_store_int(queue.where + queue.count, (at + int_lit(k * kBlockPixels)) | lane_tag, covered);
            }
            if (queue.count > SampleQueue::kRoom - kMaxSamples * kLanes)
                draw_queue(queue, first, s);
            for (int i = 0; i < 3; ++i)
                at_x[i] = at_x[i] + step_x[i];
        }
        for (int i = 0; i < 3; ++i)
            edge[i] = edge[i] + step_y[i];
    }
    draw_queue(queue, first, s);
}

} // namespace BN_ISA_NS
} // namespace burnish
