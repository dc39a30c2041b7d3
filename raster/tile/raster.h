// Coverage and depth of one triangle in one tile, in blocks of 8x8 pixels. Integer edge functions on the 1/256-pixel grid with the
// top-left rule (Pineda 1988), so shared edges neither overlap nor leave gaps. Hierarchical depth by 8x8 block.
#pragma once
#include "raster/tile/blocks.h"

namespace burnish {
inline namespace BN_ISA_NS {

// One triangle against one tile. Edge values are in units of 1/16 of (1/256 pixel)^2. Standard sample positions lie on the 1/16 pixel
// grid, so a floor division by 16 keeps every sign, and values within a block fit 32 bits.
struct TileTriangle {
    std::int64_t edge[3];                  // at the tile's top left corner, top-left rule included: inside is >= 0
    std::int32_t step_x[3], step_y[3];     // by 1/16 pixel
    std::int64_t span_min[3], span_max[3]; // least and greatest change inside a block; unset for small triangles
    std::int32_t sample_step[3][kMaxSamples];
    double z, z_x, z_y;          // depth at the first vertex, and its change by sub-pixel unit
    std::int32_t from_x, from_y; // the tile's corner from the first vertex, sub-pixel units
    float z_min, z_max, dz_x, dz_y;
    float sample_z[kMaxSamples];
    int refresh_writes;     // writes to a block before its farthest depth is updated
    int px0, px1, py0, py1; // pixels in the tile that the bounding box touches, inclusive
    bool small;             // at most a block wide and high, inside the tile or not
};

BN_INLINE int floor_shift(std::int64_t v, int n)
{
    return static_cast<int>(v >> n);
}

// Sets up a triangle. x0, y0: the tile's corner, pixels. Returns false if the triangle touches no sample in the tile.
BN_INLINE bool begin_triangle(const FrameParams& f, const TriangleSetup& t, int x0, int y0, TileTriangle& r)
{
    // Find the pixels that the bounding box touches
    const std::int32_t ox = x0 * kSubpixel - f.center_x, oy = y0 * kSubpixel - f.center_y;
    const std::int32_t last = f.tile_size - 1;
    std::int32_t lo_x = t.x[0], hi_x = t.x[0], lo_y = t.y[0], hi_y = t.y[0];
    for (int i = 1; i < 3; ++i) {
        lo_x = t.x[i] < lo_x ? t.x[i] : lo_x, hi_x = t.x[i] > hi_x ? t.x[i] : hi_x;
        lo_y = t.y[i] < lo_y ? t.y[i] : lo_y, hi_y = t.y[i] > hi_y ? t.y[i] : hi_y;
    }
    r.px0 = floor_shift(lo_x - ox - f.pattern.max_x + kSubpixel - 1, 8), r.px1 = floor_shift(hi_x - ox - f.pattern.min_x, 8);
    r.py0 = floor_shift(lo_y - oy - f.pattern.max_y + kSubpixel - 1, 8), r.py1 = floor_shift(hi_y - oy - f.pattern.min_y, 8);
    r.px0 = r.px0 > 0 ? r.px0 : 0, r.py0 = r.py0 > 0 ? r.py0 : 0;
    r.px1 = r.px1 < last ? r.px1 : last, r.py1 = r.py1 < last ? r.py1 : last;
    if (r.px0 > r.px1 || r.py0 > r.py1)
        return false;
    r.small = hi_x - lo_x <= kBlock * kSubpixel && hi_y - lo_y <= kBlock * kSubpixel; // so edges near it fit 32 bits
    // Set up the edge functions; reject the triangle if the tile lies outside an edge
    const std::int64_t tile_span = static_cast<std::int64_t>(f.tile_size) * 16 - 1, block_span = kBlock * 16 - 1;
    for (int i = 0; i < 3; ++i) {
        const int p = i == 2 ? 0 : i + 1, q = i == 0 ? 2 : i - 1; // edge opposite vertex i, from p to q
        const std::int64_t a = t.y[p] - t.y[q], b = t.x[q] - t.x[p];
        const std::int64_t at = a * (ox - t.x[p]) + b * (oy - t.y[p]);
        const bool top_left = a > 0 || (a == 0 && b > 0);
        r.edge[i] = (at - (top_left ? 0 : 1)) >> 4;
        if (!r.small) {
            if (r.edge[i] + (a > 0 ? a : 0) * tile_span + (b > 0 ? b : 0) * tile_span < 0)
                return false;
            r.span_min[i] = ((a < 0 ? a : 0) + (b < 0 ? b : 0)) * block_span;
            r.span_max[i] = ((a > 0 ? a : 0) + (b > 0 ? b : 0)) * block_span;
        }
        r.step_x[i] = static_cast<std::int32_t>(a), r.step_y[i] = static_cast<std::int32_t>(b);
        for (int s = 0; s < f.msaa; s += kLanes)
            store_int(r.sample_step[i] + s, int_lit(static_cast<std::int32_t>(a)) * load_int(f.pattern.x16 + s) +
                                                int_lit(static_cast<std::int32_t>(b)) * load_int(f.pattern.y16 + s));
    }
    // Set up the depth plane
    const double x10 = t.x[1] - t.x[0], y10 = t.y[1] - t.y[0], x20 = t.x[2] - t.x[0], y20 = t.y[2] - t.y[0];
    const double z0 = static_cast<double>(t.z[0]), z10 = static_cast<double>(t.z[1]) - z0, z20 = static_cast<double>(t.z[2]) - z0;
    depth_slopes(x10, y10, x20, y20, z10, z20, r.z_x, r.z_y);
    r.z = z0;
    r.from_x = ox - t.x[0], r.from_y = oy - t.y[0];
    r.dz_x = static_cast<float>(depth_slope_by_pixel(r.z_x)), r.dz_y = static_cast<float>(depth_slope_by_pixel(r.z_y));
    r.z_min = t.z[0] < t.z[1] ? t.z[0] : t.z[1], r.z_max = t.z[0] > t.z[1] ? t.z[0] : t.z[1];
    r.z_min = t.z[2] < r.z_min ? t.z[2] : r.z_min, r.z_max = t.z[2] > r.z_max ? t.z[2] : r.z_max;
    for (int s = 0; s < f.msaa; s += kLanes)
        store(r.sample_z + s, sample_depth_step(f, splat(r.dz_x), splat(r.dz_y), s));
    return true;
}

// A triangle's edges in lanes.
struct EdgeLanes {
    integer change[3]; // over the lanes of a register
    integer step[3];   // between registers of a block with whole rows
};
BN_INLINE EdgeLanes edge_lanes(const TileTriangle& t, const BlockLanes& lanes)
{
    EdgeLanes r;
    for (int i = 0; i < 3; ++i) {
        r.change[i] = lanes.x16 * int_lit(t.step_x[i]) + lanes.y16 * int_lit(t.step_y[i]);
        r.step[i] = int_lit(16 * t.step_y[i] * (kLanes / kBlock));
    }
    return r;
}

struct BlockEdges { // the edges that cross the block
    int count;
    int edge[3];        // their indices
    std::int32_t at[3]; // their values at the block's corner
};
BN_INLINE void add_edge(const TileTriangle& t, int edge, int bx, int by, BlockEdges& e)
{
    e.edge[e.count] = edge;
    e.at[e.count++] = static_cast<std::int32_t>(t.edge[edge] + static_cast<std::int64_t>(t.step_x[edge]) * (bx * kBlock * 16) +
                                                static_cast<std::int64_t>(t.step_y[edge]) * (by * kBlock * 16));
}

// Returns the farthest depth among a block's samples.
BN_INLINE float farthest_depth(const FrameParams& f, const float* depth)
{
    constexpr int kChains = 4; // independent chains of minima
    real far[kChains];
    for (int k = 0; k < kChains; ++k)
        far[k] = load(depth + k * kLanes);
    for (int i = kChains * kLanes; i < f.msaa * kBlockPixels; i += kChains * kLanes)
        for (int k = 0; k < kChains; ++k)
            far[k] = min(far[k], load(depth + i + k * kLanes));
    float farthest[kLanes];
    store(farthest, reduce_min(min(min(far[0], far[1]), min(far[2], far[3]))));
    return farthest[0];
}

// Returns true if the triangle's greatest depth in the block lies behind the block's farthest sample. The bound on that sample is updated
// only from time to time. It may be too low but never too high, so it cannot change the picture.
template <bool kAnyOrder>
BN_INLINE bool block_hidden(const FrameParams& f, const TileTriangle& t, float nearest, int block, const float* depth, TileScratch& scratch)
{
    const auto hidden = [&](float farthest) { return kAnyOrder ? nearest < farthest : nearest <= farthest; };
    if (hidden(scratch.block_far[block]))
        return true;
    // Recompute the farthest depth after enough writes
    if (scratch.block_dirty[block] < t.refresh_writes)
        return false;
    scratch.block_far[block] = farthest_depth(f, depth);
    scratch.block_dirty[block] = 0;
    return hidden(scratch.block_far[block]);
}

struct NoAlpha {}; // opaque: every covered sample counts

// Tests and writes depth for the samples in a pixel register. at: kEdges edge values at the pixels' corners; z: depth there. alive: pixels
// that survive an alpha test; or null.
template <int kEdges, bool kAnyOrder>
BN_INLINE bool cover_register(const FrameParams& f, const TileTriangle& t, const BlockEdges& e, const integer at[3], real z,
                              integer lane_id, float* depth, std::int32_t* ids, const std::uint32_t* alive)
{
    const real z_min = splat(t.z_min), z_max = splat(t.z_max);
    mask written = mask_from_bits(0);
    for (int s = 0; s < f.msaa; ++s) {
        float* d = depth + s * kBlockPixels;
        std::int32_t* to = ids + s * kBlockPixels;
        const real zs = depth_at_sample(z, splat(t.sample_z[s]), z_min, z_max);
        const real old = load(d);
        // Depth test, then coverage
        mask pass = zs > old;
        if constexpr (kAnyOrder)
            pass = either(pass, both(zs == old, lane_id < load_int(to)));
        if constexpr (kEdges > 0) {
            integer side = at[0] + int_lit(t.sample_step[e.edge[0]][s]);
            for (int i = 1; i < kEdges; ++i)
                side = side | (at[i] + int_lit(t.sample_step[e.edge[i]][s]));
            pass = both(pass, side >= int_lit(0));
        }
        if (alive)
            pass = both(pass, mask_from_bits(*alive));
        store(d, select(pass, zs, old));
        store_int(to, select(pass, lane_id, load_int(to)));
        written = either(written, pass);
    }
    return any(written);
}

// Edge values at the pixel corners of a register, for edges that cross the block.
template <int kEdges> struct RegisterEdges {
    integer at[kEdges > 0 ? kEdges : 1];
    integer step[kEdges > 0 ? kEdges : 1];
};
template <int kEdges>
BN_INLINE RegisterEdges<kEdges> edges_of_register(const TileTriangle& t, const EdgeLanes& edges, const BlockEdges& e, int v)
{
    const int vx = v * kLanes & 7, vy = v * kLanes >> 3;
    RegisterEdges<kEdges> r;
    for (int i = 0; i < kEdges; ++i) {
        const int k = e.edge[i];
        r.at[i] = int_lit(e.at[i] + 16 * (t.step_x[k] * vx + t.step_y[k] * vy)) + edges.change[k];
        r.step[i] = edges.step[k];
    }
    return r;
}
// Advances to the next register. v: the current one.
template <int kEdges>
BN_INLINE void next_register(const TileTriangle& t, const EdgeLanes& edges, const BlockEdges& e, int v, RegisterEdges<kEdges>& r)
{
    if constexpr (kLanes < kBlock)
        r = edges_of_register<kEdges>(t, edges, e, v + 1);
    for (int i = 0; i < kEdges && kLanes >= kBlock; ++i)
        r.at[i] = r.at[i] + r.step[i];
}

// Returns the triangle's depth at the pixel corners of register v in a block.
BN_INLINE real depths_of_register(const BlockLanes& lanes, real z_corner, real dz_x, real dz_y, int v)
{
    const int vx = v * kLanes & 7, vy = v * kLanes >> 3;
    const real x = lanes.x + splat(static_cast<float>(vx)), y = lanes.y + splat(static_cast<float>(vy));
    return z_corner + depth_change(dz_x, dz_y, x, y);
}

// Registers of a block's rows.
struct RegisterRange {
    int first, last;
};
BN_INLINE RegisterRange registers_of_rows(int row0, int row1)
{
    return {row0 * kBlock / kLanes, (row1 * kBlock + kBlock - 1) / kLanes};
}

// Tests and writes depth for one block of an opaque triangle.
template <int kEdges, bool kAnyOrder>
BN_INLINE bool cover_block(const FrameParams& f, const TileTriangle& t, const EdgeLanes& of_triangle, const BlockEdges& e,
                           const BlockLanes& lanes, float z_corner, int row0, int row1, std::uint32_t id, float* depth, std::uint32_t* ids,
                           const NoAlpha&)
{
    const real dz_x = splat(t.dz_x), dz_y = splat(t.dz_y);
    const integer lane_id = int_lit(static_cast<std::int32_t>(id));
    const RegisterRange range = registers_of_rows(row0, row1);
    bool wrote = false;
    RegisterEdges<kEdges> edges = edges_of_register<kEdges>(t, of_triangle, e, range.first);
    for (int v = range.first; v <= range.last; ++v, next_register<kEdges>(t, of_triangle, e, v - 1, edges)) {
        const real z = depths_of_register(lanes, splat(z_corner), dz_x, dz_y, v);
        float* const to_depth = depth + v * kLanes;
        std::int32_t* const to_ids = reinterpret_cast<std::int32_t*>(ids) + v * kLanes;
        wrote = cover_register<kEdges, kAnyOrder>(f, t, e, edges.at, z, lane_id, to_depth, to_ids, nullptr) || wrote;
    }
    return wrote;
}

// Tests and writes depth for one block of a triangle with alpha test. First collects the pixels that may show it, so that
// `alpha.find(pixels, n, to)` works on full registers. alpha.staying() returns the pixels whose samples stay.
template <int kEdges, bool kAnyOrder, class Alpha>
BN_INLINE bool cover_block(const FrameParams& f, const TileTriangle& t, const EdgeLanes& of_triangle, const BlockEdges& e,
                           const BlockLanes& lanes, float z_corner, int row0, int row1, std::uint32_t id, float* depth, std::uint32_t* ids,
                           const Alpha& alpha)
{
    const real z_min = splat(t.z_min), z_max = splat(t.z_max), dz_x = splat(t.dz_x), dz_y = splat(t.dz_y);
    const integer lane_id = int_lit(static_cast<std::int32_t>(id)), zero = int_lit(0);
    const RegisterRange range = registers_of_rows(row0, row1);
    std::int32_t pixels[kBlockPixels + kLanes]; // whole registers are written
    float found[kBlockPixels + kLanes];
    std::uint32_t shown[kVectors]; // by register: pixels that may show the triangle at some sample
    int count = 0;
    const RegisterEdges<kEdges> first = edges_of_register<kEdges>(t, of_triangle, e, range.first);
    RegisterEdges<kEdges> edges = first;
    // Collect candidate pixels: covered and not hidden at some sample
    for (int v = range.first; v <= range.last; ++v, next_register<kEdges>(t, of_triangle, e, v - 1, edges)) {
        const real z = depths_of_register(lanes, splat(z_corner), dz_x, dz_y, v);
        shown[v] = 0;
        for (int s = 0; s < f.msaa; ++s) {
            integer side = zero;
            for (int i = 0; i < kEdges; ++i)
                side = side | (edges.at[i] + int_lit(t.sample_step[e.edge[i]][s]));
            const real zs = depth_at_sample(z, splat(t.sample_z[s]), z_min, z_max);
            shown[v] |= to_bits(both(side >= zero, zs >= load(depth + s * kBlockPixels + v * kLanes)));
        }
        count += compress_store_int(pixels + count, iota() + int_lit(v * kLanes), mask_from_bits(shown[v]));
    }
    if (count == 0)
        return false;
    // Find their alpha
    alpha.find(pixels, count, found);
    const float* of_register = found;
    bool wrote = false;
    // Test and write the pixels that stay
    edges = first;
    for (int v = range.first; v <= range.last; ++v, next_register<kEdges>(t, of_triangle, e, v - 1, edges)) {
        if (!shown[v])
            continue;
        const real value = expand_load(of_register, mask_from_bits(shown[v]));
        of_register += __builtin_popcount(shown[v]);
        const std::uint32_t alive = shown[v] & alpha.staying(value);
        const real z = depths_of_register(lanes, splat(z_corner), dz_x, dz_y, v);
        wrote = cover_register<kEdges, kAnyOrder>(f, t, e, edges.at, z, lane_id, depth + v * kLanes,
                                                  reinterpret_cast<std::int32_t*>(ids) + v * kLanes, &alive) ||
                wrote;
    }
    return wrote;
}

// Returns the depth at a block's corner. It is computed from the vertex, not from the tile, so that it is equal for every tile size.
BN_INLINE float corner_depth(const TileTriangle& t, int bx, int by)
{
    const double from_x = t.from_x + bx * kBlock * kSubpixel, from_y = t.from_y + by * kBlock * kSubpixel;
    return static_cast<float>(depth_at(t.z, t.z_x, t.z_y, from_x, from_y));
}

// Rasterizes a small triangle that lanes do not share (small_triangles.h): its material tests alpha, or it is a clipped piece. Tests for
// hidden blocks or for crossing edges would cost more than they save.
template <bool kAnyOrder, class MakeAlpha>
BN_INLINE void raster_small_triangle(const FrameParams& f, const TileTriangle& t, std::uint32_t id, TileScratch& scratch,
                                     const MakeAlpha& make_alpha)
{
    const int blocks_x = f.tile_size / kBlock;
    const BlockLanes lanes = block_lanes();
    const EdgeLanes edges = edge_lanes(t, lanes);
    for (int by = t.py0 / kBlock; by <= t.py1 / kBlock; ++by) {
        const int row0 = t.py0 > by * kBlock ? t.py0 - by * kBlock : 0;
        const int row1 = t.py1 < by * kBlock + kBlock - 1 ? t.py1 - by * kBlock : kBlock - 1;
        for (int bx = t.px0 / kBlock; bx <= t.px1 / kBlock; ++bx) {
            BlockEdges e;
            e.count = 0;
            for (int i = 0; i < 3; ++i)
                add_edge(t, i, bx, by, e);
            const int block = by * blocks_x + bx, at = block * f.msaa * kBlockPixels;
            if (t.z_max < scratch.block_far[block]) // hidden, or the block has no further blended layer
                continue;
            if (scratch.block_state[block] != BlockState::drawn)
                write_block(f, block, scratch);
            if (cover_block<3, kAnyOrder>(f, t, edges, e, lanes, corner_depth(t, bx, by), row0, row1, id, scratch.depth + at,
                                          scratch.ids + at, make_alpha(bx, by)) &&
                scratch.block_dirty[block] < 255)
                ++scratch.block_dirty[block];
        }
    }
}

struct TouchedBlocks {             // bit b: block b in the tile
    std::uint64_t all, crossed[3]; // not outside any edge; cut by edge i
};
static_assert(kMaxTileSize / kBlock * (kMaxTileSize / kBlock) <= 64);

// Finds the blocks that a triangle touches, kLanes blocks at once. Block corners lie multiples of 128 units from the tile's corner. So
// values floor-divided by 32 keep their signs, and values that may change sign in the tile fit 32 bits.
BN_INLINE TouchedBlocks touched_blocks(const TileTriangle& t, int blocks_x)
{
    constexpr int kShift = 5, kStep = kBlock * 16 >> kShift;
    const auto fitting = [](std::int64_t v) {
        constexpr std::int64_t kFar = 1 << 30; // changes over a tile are below 2^29
        v >>= kShift;
        return int_lit(static_cast<std::int32_t>(v > kFar ? kFar : v < -kFar ? -kFar : v));
    };
    // Take the bounding box
    const int x0 = t.px0 / kBlock, x1 = t.px1 / kBlock, first = t.py0 / kBlock * blocks_x, end = (t.py1 / kBlock + 1) * blocks_x;
    const std::uint64_t row = (std::uint64_t{2} << x1) - (std::uint64_t{1} << x0);
    TouchedBlocks r = {0, {0, 0, 0}};
    for (int block = first; block < end; block += blocks_x)
        r.all |= row << block;
    // Remove blocks outside an edge, and note crossing edges
    integer greatest[3], least[3], step_x[3], step_y[3];
    for (int i = 0; i < 3; ++i) {
        greatest[i] = fitting(t.edge[i] + t.span_max[i]), least[i] = fitting(t.edge[i] + t.span_min[i]);
        step_x[i] = int_lit(t.step_x[i] * kStep), step_y[i] = int_lit(t.step_y[i] * kStep);
    }
    const int shift = __builtin_ctz(static_cast<unsigned>(blocks_x));
    std::uint64_t outside = 0;
    for (int block = first / kLanes * kLanes; block < end; block += kLanes) {
        const integer b = iota() + int_lit(block), bx = b & int_lit(blocks_x - 1), by = shr(b, shift);
        integer leaves = int_lit(0);
        for (int i = 0; i < 3; ++i) {
            const integer change = step_x[i] * bx + step_y[i] * by;
            leaves = leaves | (greatest[i] + change);
            r.crossed[i] |= std::uint64_t{to_bits(least[i] + change < int_lit(0))} << block;
        }
        outside |= std::uint64_t{to_bits(leaves < int_lit(0))} << block;
    }
    r.all &= ~outside;
    return r;
}

// Returns true if a triangle that covers a block certainly lies before the block's contents. Depth 0 stands for empty and passes no test.
BN_INLINE bool hides_block(const DepthBounds& bounds, BlockState state, int block, const TileScratch& s)
{
    if (state == BlockState::drawn || bounds.farthest <= 0.0f)
        return false;
    return state == BlockState::empty || bounds.farthest > depth_bounds(s.block_plane[block]).nearest;
}

// Rasterizes triangle `id` of the tile's list. `make_alpha(block_x, block_y)` returns the alpha test for a block. kAnyOrder: the triangle
// is drawn out of order, so the lower id must win at equal depths. In list order it wins by itself.
template <bool kAnyOrder, class MakeAlpha>
BN_INLINE void raster_triangle(const FrameParams& f, const TileTriangle& t, std::uint32_t id, TileScratch& scratch,
                               const MakeAlpha& make_alpha)
{
    if (t.small) {
        raster_small_triangle<kAnyOrder>(f, t, id, scratch, make_alpha);
        return;
    }
    const int blocks_x = f.tile_size / kBlock;
    const BlockLanes lanes = block_lanes();
    const EdgeLanes edges = edge_lanes(t, lanes);
    const TouchedBlocks touched = touched_blocks(t, blocks_x);
    for (std::uint64_t blocks = touched.all; blocks; blocks &= blocks - 1) {
        const int block = __builtin_ctzll(blocks), bx = block % blocks_x, by = block / blocks_x;
        const int row0 = t.py0 > by * kBlock ? t.py0 - by * kBlock : 0;
        const int row1 = t.py1 < by * kBlock + kBlock - 1 ? t.py1 - by * kBlock : kBlock - 1;
        // Collect the edges that cross the block
        BlockEdges e;
        e.count = 0;
        for (int i = 0; i < 3; ++i)
            if (touched.crossed[i] >> block & 1u) // else the whole block lies inside this edge
                add_edge(t, i, bx, by, e);
        // Skip the block if it is hidden; defer it if the triangle fills it
        const float z_corner = corner_depth(t, bx, by);
        const BlockPlane plane = {z_corner, t.dz_x, t.dz_y, t.z_min, t.z_max, id};
        const DepthBounds bounds = depth_bounds(plane);
        float* depth = scratch.depth + block * f.msaa * kBlockPixels;
        if (block_hidden<kAnyOrder>(f, t, bounds.nearest, block, depth, scratch))
            continue;
        const BlockState state = scratch.block_state[block];
        if (!MakeAlpha::kTests && e.count == 0 && hides_block(bounds, state, block, scratch)) {
            take_block(plane, bounds.farthest, block, scratch);
            continue;
        }
        // Draw samples, with code for the number of crossing edges
        if (state != BlockState::drawn)
            write_block(f, block, scratch);
        std::uint32_t* ids = scratch.ids + block * f.msaa * kBlockPixels;
        const auto alpha = make_alpha(bx, by);
        bool wrote = false;
        switch (e.count) {
        case 0:
            wrote = cover_block<0, kAnyOrder>(f, t, edges, e, lanes, z_corner, row0, row1, id, depth, ids, alpha);
            break;
        case 1:
            wrote = cover_block<1, kAnyOrder>(f, t, edges, e, lanes, z_corner, row0, row1, id, depth, ids, alpha);
            break;
        case 2:
            wrote = cover_block<2, kAnyOrder>(f, t, edges, e, lanes, z_corner, row0, row1, id, depth, ids, alpha);
            break;
        default:
            wrote = cover_block<3, kAnyOrder>(f, t, edges, e, lanes, z_corner, row0, row1, id, depth, ids, alpha);
            break;
        }
        if (wrote && scratch.block_dirty[block] < 255)
            ++scratch.block_dirty[block];
    }
}

} // namespace BN_ISA_NS
} // namespace burnish
