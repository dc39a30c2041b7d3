// Front end in lanes: vertices to the sub-pixel grid, triangles to setups. Compiled once for every instruction set.
#include "raster/tile/geometry.h"

#include "raster/tile/lanes_view.h"

namespace burnish {
inline namespace BN_ISA_NS {

void transform_vertices(const FrameParams& f, std::uint32_t first, std::uint32_t count)
{
    const view_params view = lanes_view(f.view);
    for (std::uint32_t i = 0; i < count; i += kLanes) {
        const std::uint32_t v = first + i;
        const int n = static_cast<int>(count - i < kLanes ? count - i : kLanes);
        const real3 p = vec3_of(load_first(f.px + v, n), load_first(f.py + v, n), load_first(f.pz + v, n));
        const snapped_vertex s = snap_lanes(f, view, clip_position(p, view), kWholeBand);
        store_first(f.vertices.x + v, select(s.valid, s.x, int_lit(kNeedsClip)), n);
        store_first(f.vertices.y + v, s.y, n);
        store_first(f.vertices.inv_w + v, s.inv_w, n);
        store_first(f.vertices.z + v, s.z, n);
    }
}

namespace {

struct LaneTriangle {
    integer x[3], y[3], vertex[3];
};

BN_INLINE integer min3(integer a, integer b, integer c)
{
    const integer m = select(a < b, a, b);
    return select(m < c, m, c);
}
BN_INLINE integer max3(integer a, integer b, integer c)
{
    const integer m = select(a > b, a, b);
    return select(m > c, m, c);
}

struct AreaSigns {
    mask positive, negative;
};

// Twice the signed area needs 47 bits; where all differences are below 2^15 (128 pixels) 32 bits hold it exactly.
BN_INLINE AreaSigns area_signs(const LaneTriangle& t, mask valid)
{
    const integer ax = t.x[1] - t.x[0], ay = t.y[1] - t.y[0], bx = t.x[2] - t.x[0], by = t.y[2] - t.y[0];
    const integer area = ax * by - bx * ay;
    const integer range = int_lit(1 << 15);
    const auto small = [&](integer d) { return both(d < range, int_lit(0) - range < d); };
    const mask is_small = both(both(small(ax), small(ay)), both(small(bx), small(by)));
    std::uint32_t positive = to_bits(area > int_lit(0)), negative = to_bits(area < int_lit(0));
    std::uint32_t large = to_bits(both(valid, not_(is_small)));
    if (large) {
        std::int32_t d[4][kLanes];
        store_int(d[0], ax), store_int(d[1], ay), store_int(d[2], bx), store_int(d[3], by);
        for (; large; large &= large - 1) {
            const int i = __builtin_ctz(large);
            const std::int64_t a = static_cast<std::int64_t>(d[0][i]) * d[3][i] - static_cast<std::int64_t>(d[2][i]) * d[1][i];
            const std::uint32_t bit = 1u << i;
            positive = a > 0 ? positive | bit : positive & ~bit;
            negative = a < 0 ? negative | bit : negative & ~bit;
        }
    }
    return {mask_from_bits(positive), mask_from_bits(negative)};
}

// Everything about up to kLanes triangles that is stored, in plain memory, lane by lane.
struct SetupStore {
    std::int32_t field[15][kLanes];
    std::int32_t rect[4][kLanes];
};

BN_INLINE void emit(const SetupStore& s, int lane, std::int32_t info, std::uint32_t triangle, ChunkOutput& out)
{
    std::int32_t words[16];
    for (int i = 0; i < 15; ++i)
        words[i] = s.field[i][lane];
    words[15] = info;
    __builtin_memcpy(static_cast<void*>(out.setups + out.count), words, sizeof words);
    out.rects[out.count] = {static_cast<std::uint16_t>(s.rect[0][lane]), static_cast<std::uint16_t>(s.rect[1][lane]),
                            static_cast<std::uint16_t>(s.rect[2][lane]), static_cast<std::uint16_t>(s.rect[3][lane])};
    out.triangles[out.count] = triangle;
    ++out.count;
}

// First and last pixel whose samples the range [lo, hi] of sub-pixel positions can cover, to inclusive tiles; shift = log2 of
// the tile side. Returns where the range holds a pixel of the image.
BN_INLINE mask tile_range(integer lo, integer hi, int center, int sample_min, int sample_max, int size, int tile_shift,
                          integer& tile_lo, integer& tile_hi)
{
    integer p0 = shr(lo + int_lit(center - sample_max + kSubpixel - 1), 8);
    integer p1 = shr(hi + int_lit(center - sample_min), 8);
    p0 = select(p0 < int_lit(0), int_lit(0), p0);
    p1 = select(p1 > int_lit(size - 1), int_lit(size - 1), p1);
    const mask some = p0 <= p1;
    tile_lo = shr(p0, tile_shift);
    tile_hi = shr(p1, tile_shift);
    return some;
}

void setup_lanes(const FrameParams& f, std::uint32_t first, int n, ChunkOutput& out)
{
    const std::uint32_t lanes_used = n >= 32 ? 0xffffffffu : (1u << n) - 1;
    const mask used = mask_from_bits(lanes_used);
    const integer at = select(used, iota() * int_lit(3), int_lit(0));
    const std::int32_t* indices = reinterpret_cast<const std::int32_t*>(f.indices + 3 * static_cast<std::size_t>(first));
    LaneTriangle t;
    for (int k = 0; k < 3; ++k) {
        t.vertex[k] = gather_int(indices + k, at);
        t.x[k] = gather_int(f.vertices.x, t.vertex[k]);
        t.y[k] = gather_int(f.vertices.y, t.vertex[k]);
    }
    const integer clip_mark = int_lit(kNeedsClip);
    const mask clip =
        both(used, either(either(t.x[0] == clip_mark, t.x[1] == clip_mark), t.x[2] == clip_mark));
    const mask whole = both(used, not_(clip));

    SetupStore s;
    const int shift = f.tile_size == 64 ? 6 : 5;
    integer tx0, tx1, ty0, ty1;
    mask keep = both(whole, tile_range(min3(t.x[0], t.x[1], t.x[2]), max3(t.x[0], t.x[1], t.x[2]), f.center_x, f.pattern.min_x,
                                       f.pattern.max_x, f.width, shift, tx0, tx1));
    keep = both(keep, tile_range(min3(t.y[0], t.y[1], t.y[2]), max3(t.y[0], t.y[1], t.y[2]), f.center_y, f.pattern.min_y,
                                 f.pattern.max_y, f.height, shift, ty0, ty1));
    if (none(either(keep, clip)))
        return;
    const AreaSigns sign = area_signs(t, keep);
    const mask front = sign.negative; // counter-clockwise with y up is clockwise with y down
    keep = both(keep, either(sign.positive, front));
    store_int(s.rect[0], tx0), store_int(s.rect[1], ty0), store_int(s.rect[2], tx1), store_int(s.rect[3], ty1);
    for (int k = 0; k < 3; ++k) { // a front face's second and third vertex change places: the area becomes positive
        const int o = k == 0 ? 0 : 3 - k;
        const integer vertex = select(front, t.vertex[o], t.vertex[k]);
        store_int(s.field[k], select(front, t.x[o], t.x[k]));
        store_int(s.field[3 + k], select(front, t.y[o], t.y[k]));
        store_int(s.field[6 + k], bits_of(gather(f.vertices.inv_w, vertex)));
        store_int(s.field[9 + k], bits_of(gather(f.vertices.z, vertex)));
        store_int(s.field[12 + k], vertex);
    }
    const std::uint32_t keep_bits = to_bits(keep), clip_bits = to_bits(clip), front_bits = to_bits(front);
    for (std::uint32_t rest = keep_bits | clip_bits; rest; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        const std::uint32_t triangle = first + static_cast<std::uint32_t>(lane);
        if (clip_bits >> lane & 1u) {
            clip_triangle(f, triangle, out);
            continue;
        }
        const std::uint32_t material = f.triangle_material[triangle];
        const bool is_front = (front_bits >> lane & 1u) != 0;
        if (!is_front && !f.materials[material].double_sided)
            continue;
        emit(s, lane, static_cast<std::int32_t>(material << 2) | (is_front ? kFrontFacing : 0), triangle, out);
    }
}

} // namespace

void setup_triangles(const FrameParams& f, std::uint32_t first, std::uint32_t count, ChunkOutput& out)
{
    for (std::uint32_t i = 0; i < count; i += kLanes) {
        if (out.count + kGrowRoom > out.capacity || out.clip_count + kGrowRoom > out.clip_capacity)
            out.grow(&out);
        setup_lanes(f, first + i, static_cast<int>(count - i < kLanes ? count - i : kLanes), out);
    }
}

} // namespace BN_ISA_NS
} // namespace burnish
