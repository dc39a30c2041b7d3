// Front end in lanes: snaps vertices to the sub-pixel grid and bins triangles. Compiled once per instruction set.
#include "raster/tile/geometry.h"

#include "raster/tile/lane_triangles.h"
#include "shading/kernels/camera.t.h"
#include "shading/kernels/pixel_range.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

void transform_vertices(const FrameParams& f, std::uint32_t first, std::uint32_t count)
{
    const view_params view = view_params_of(f.view);
    for (std::uint32_t i = 0; i < count; i += kLanes) {
        const std::uint32_t v = first + i;
        const int n = static_cast<int>(count - i < kLanes ? count - i : kLanes);
        const real3 p = vec3_of(load_first(f.px + v, n), load_first(f.py + v, n), load_first(f.pz + v, n));
        const snapped_vertex s = snap_to_frame(f, clip_position(p, view), view, kWholeBand);
        const integer fields[4] = {select(s.valid, s.x, int_lit(kNeedsClip)), s.y, bits_of(s.inv_w), bits_of(s.z)};
        store_quads(f.vertices + v, fields, n);
    }
}

namespace {

struct TileAxis { // the tiles along an axis
    int begin;    // first own pixel of the first tile
    int count;
};

// Computes the inclusive range of tiles whose samples the sub-pixel range [lo, hi] can cover. Returns the lanes whose range holds an image
// pixel.
BN_INLINE mask tile_range(const FrameParams& f, integer lo, integer hi, int center, int sample_min, int sample_max, int size,
                          const TileAxis& tiles, integer& tile_lo, integer& tile_hi)
{
    const pixel_range r = pixels_touched(lo, hi, center, sample_min, sample_max, size);
    const integer zero = int_lit(0), last = int_lit(tiles.count - 1);
    if (f.tile_rim == 0 && tiles.begin == 0) { // steps are powers of two
        const int shift = __builtin_ctz(static_cast<unsigned>(f.tile_step));
        tile_lo = min(shr(r.first, shift), last), tile_hi = min(shr(r.last, shift), last);
        return r.first <= r.last;
    }
    const real by_step = splat(1.0f / static_cast<float>(f.tile_step));
    // Half a pixel keeps rounding away from whole numbers
    const auto tile_of = [&](integer pixel) { return min(to_int((to_real(max(pixel, zero)) + lit(0.5)) * by_step), last); };
    tile_lo = tile_of(r.first - int_lit(tiles.begin + f.tile_rim));
    tile_hi = tile_of(r.last - int_lit(tiles.begin - f.tile_rim));
    return r.first <= r.last;
}

// Returns the back faces among `backs` whose materials are single-sided.
BN_INLINE std::uint32_t culled_backs(const FrameParams& f, std::uint32_t first, std::uint32_t backs)
{
    std::uint32_t culled = 0;
    for (; backs; backs &= backs - 1) {
        const std::uint32_t lane = static_cast<std::uint32_t>(__builtin_ctz(backs));
        if (!f.materials[f.triangle_material[first + lane]].double_sided)
            culled |= 1u << lane;
    }
    return culled;
}

void bin_lanes(const FrameParams& f, std::uint32_t first, int n, ChunkOutput& out)
{
    // Load the triangles, and find those that need clipping
    const mask used = iota() < int_lit(n);
    const integer id = iota() + int_lit(static_cast<std::int32_t>(first));
    LaneTriangles t;
    load_positions(f, select(used, id, int_lit(static_cast<std::int32_t>(first))), n == kLanes, first, t);
    const integer clip_mark = int_lit(kNeedsClip);
    const mask clip = both(used, either(either(t.x[0] == clip_mark, t.x[1] == clip_mark), t.x[2] == clip_mark));

    // Drop triangles outside the image and culled back faces
    integer tx0, tx1, ty0, ty1;
    mask keep = both(used, not_(clip));
    keep = both(keep, tile_range(f, min3(t.x), max3(t.x), f.center_x, f.pattern.min_x, f.pattern.max_x, f.width, {0, f.tiles_x}, tx0, tx1));
    keep =
        both(keep, tile_range(f, min3(t.y), max3(t.y), f.center_y, f.pattern.min_y, f.pattern.max_y, f.height, {0, f.tiles_y}, ty0, ty1));
    if (none(either(keep, clip)))
        return;
    const AreaSigns sign = area_signs(t, keep);
    keep = both(keep, either(sign.positive, sign.negative));
    const std::uint32_t culled = culled_backs(f, first, to_bits(both(keep, sign.positive)));
    keep = both(keep, not_(mask_from_bits(culled)));
    // Compress the kept triangles, and merge runs with equal rectangles
    const integer first_tile = tx0 | shl(ty0, 16), last_tile = tx1 | shl(ty1, 16);
    std::uint32_t corners[2][kLanes];
    store_int(corners[0], first_tile), store_int(corners[1], last_tile);
    const std::uint32_t clip_bits = to_bits(clip), keep_bits = to_bits(keep);
    const auto add_lane_run = [&](int lane) { add_run(out, corners[0][lane], corners[1][lane], 1); };
    if (clip_bits == 0) {
        if (keep_bits == 0)
            return;
        const std::uint32_t a = corners[0][__builtin_ctz(keep_bits)], b = corners[1][__builtin_ctz(keep_bits)];
        const mask alike = both(first_tile == int_lit(static_cast<std::int32_t>(a)), last_tile == int_lit(static_cast<std::int32_t>(b)));
        const std::uint32_t kept =
            static_cast<std::uint32_t>(compress_store_int(reinterpret_cast<std::int32_t*>(out.entries + out.count), id, keep));
        out.count += kept;
        if ((keep_bits & ~to_bits(alike)) == 0) {
            add_run(out, a, b, kept);
            return;
        }
        for (std::uint32_t rest = keep_bits; rest; rest &= rest - 1)
            add_lane_run(__builtin_ctz(rest));
        return;
    }
    // With clipped triangles, append one by one in draw order
    for (std::uint32_t rest = keep_bits | clip_bits; rest; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        const std::uint32_t triangle = first + static_cast<std::uint32_t>(lane);
        if (clip_bits >> lane & 1u) {
            clip_triangle(f, triangle, out);
            continue;
        }
        add_lane_run(lane);
        out.entries[out.count++] = triangle;
    }
}

} // namespace

void bin_triangles(const FrameParams& f, std::uint32_t first, std::uint32_t count, ChunkOutput& out)
{
    for (std::uint32_t i = 0; i < count; i += kLanes) {
        if (out.count + kGrowRoom > out.capacity || out.piece_count + kGrowRoom > out.piece_capacity)
            out.grow(&out);
        bin_lanes(f, first + i, static_cast<int>(count - i < kLanes ? count - i : kLanes), out);
    }
}

void touch_tiles(const FrameParams& f, int left, int top, const std::uint32_t* entries, std::uint32_t count, std::uint32_t* first_tile,
                 std::uint32_t* last_tile)
{
    const integer zero = int_lit(0), all_tiles = int_lit((f.tiles_x - 1) | (f.tiles_y - 1) << 16);
    for (std::uint32_t i = 0; i < count; i += kLanes) {
        const integer entry = load_int(entries + i);
        const mask whole = both(iota() < int_lit(static_cast<std::int32_t>(count - i)), entry >= zero);
        LaneTriangles t;
        load_positions(f, select(whole, entry, zero), false, 0, t);
        integer tx0, tx1, ty0, ty1;
        tile_range(f, min3(t.x), max3(t.x), f.center_x, f.pattern.min_x, f.pattern.max_x, f.width, {left, f.tiles_x}, tx0, tx1);
        tile_range(f, min3(t.y), max3(t.y), f.center_y, f.pattern.min_y, f.pattern.max_y, f.height, {top, f.tiles_y}, ty0, ty1);
        store_int(first_tile + i, select(whole, tx0 | shl(ty0, 16), zero));
        store_int(last_tile + i, select(whole, tx1 | shl(ty1, 16), all_tiles));
    }
}

} // namespace BN_ISA_NS
} // namespace burnish
