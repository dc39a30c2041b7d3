// Filtered fetches from a bordered 2D texture pyramid: wrapping, bilinear, trilinear, anisotropic.
//
// Memory: RGBA half texels. Level l is (width_l + 2) x (height_l + 2) with a one-texel border that the wrap modes fill,
// rows from the top. Any size; width_l = max(1, floor(width / 2^l)).
//
// Level of detail and footprint follow Vulkan 1.3, "Image Sample Operations" (the scheme of
// EXT_texture_filter_anisotropic), with exact derivative lengths. P_max and P_min are the longer and the shorter of
// |d(texels)/dx| and |d(texels)/dy|:
//    e = min(P_max / P_min, max_taps),  lod = log2(P_max / e),  N = ceil(e).
// N taps of equal weight lie along the longer derivative at i/(N+1) - 1/2, i = 1..N. Two refinements keep N small where
// more taps would not show. N is at most ceil(P_max), as denser taps repeat texels of level 0. An e that exceeds a whole
// number by less than 1/256 is rounded down; else isotropic footprints would flicker between one and two taps.
#ifndef BN_TEXTURE_FILTER_K_H
#define BN_TEXTURE_FILTER_K_H
#include "shading/kernels/math.k.h"
#include "shading/kernels/texel_rows.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct texture_desc { // uniform
    texel_buffer texels;
    int_table offset;       // by level, in texels
    real_table level_width; // by level, in texels
    real_table level_height;
    int levels;  // 1 to 16
    int wrap_s;  // along u: 0 repeat, 1 clamp to edge, 2 mirrored repeat
    int wrap_t;  // along v
    int nearest; // 1: the nearest texel of level 0
};

struct texture_footprint {
    real lod;   // [0, levels - 1]
    real taps;  // whole number, [1, max_taps]
    real2 axis; // the longer derivative, uv units; 0 where it is not finite
};

// Wraps a coordinate to [0,1]; texel centres lie at (i + 1/2) / n. NaN and Inf give 0.
BN_FN real texture_wrap(real u, int mode)
{
    real r = u;
    if (mode == 0) {
        r = u - floor(u);
    }
    if (mode == 2) {
        real t = u * lit(0.5);
        real s = t - floor(t);
        r = lit(1.0) - abs(s * lit(2.0) - lit(1.0));
    }
    return min(max(r, lit(0.0)), lit(1.0));
}

// Computes level and taps. duv_dx, duv_dy: change of uv per pixel. NaN, Inf and overlong derivatives give the smallest
// level and one tap.
BN_FN texture_footprint texture_footprint_of(texture_desc desc, real2 duv_dx, real2 duv_dy, int max_taps)
{
    // Measure the derivatives in texels of level 0
    real2 size = vec2_of(table_value(desc.level_width, int_lit(0)), table_value(desc.level_height, int_lit(0)));
    real2 dx = duv_dx * size;
    real2 dy = duv_dy * size;
    real px2 = k_dot2(dx, dx);
    real py2 = k_dot2(dy, dy);
    mask valid = both(px2 <= lit(1e20), py2 <= lit(1e20));
    mask x_longer = px2 >= py2;
    real longer2 = select(valid, max(px2, py2), lit(1e20));
    real shorter2 = select(valid, min(px2, py2), lit(1e20));
    // Limit the anisotropy, and choose taps and level
    real longer = sqrt(longer2);
    real limit = to_real(int_lit(max_taps));
    real ratio = sqrt(longer2 / max(shorter2, lit(1e-15)));
    real e = min(max(ratio, lit(1.0)), limit);
    texture_footprint p;
    real useful = min(e, max(longer, lit(1.0)));
    p.taps = ceil(useful - lit(0.00390625));
    real last = to_real(int_lit(desc.levels - 1));
    p.lod = min(max(k_log2(longer / e), lit(0.0)), last);
    // Keep the longer derivative as the tap axis
    real2 axis = select(x_longer, duv_dx, duv_dy);
    p.axis = select(valid, axis, vec2_all(lit(0.0)));
    return p;
}

struct texture_level {
    integer first; // index of the level's first texel, border included
    integer stride;
    real width;
    real height;
};
// Looks up a level's place and size.
BN_FN texture_level texture_level_of(texture_desc desc, integer level)
{
    texture_level l;
    l.first = table_int(desc.offset, level);
    l.width = table_value(desc.level_width, level);
    l.height = table_value(desc.level_height, level);
    l.stride = to_int(l.width) + int_lit(2);
    return l;
}

// Computes the four texels and weights of a bilinear fetch. uv: wrapped, [0,1].
BN_FN texel_rows texture_bilinear_rows(texture_level level, real2 uv, real weight)
{
    real x = uv.x * level.width + lit(0.5);
    real y = uv.y * level.height + lit(0.5);
    integer ix = to_int(x);
    integer iy = to_int(y);
    real fx = x - to_real(ix);
    real fy = y - to_real(iy);
    real lower = weight * fy;
    real upper = weight - lower;
    real w10 = upper * fx;
    real w11 = lower * fx;
    real w00 = upper - w10;
    real w01 = lower - w11;
    texel_rows r;
    r.row0 = level.first + iy * level.stride + ix;
    r.row1 = r.row0 + level.stride;
    r.w00 = w00;
    r.w10 = w10;
    r.w01 = w01;
    r.w11 = w11;
    return r;
}

// Computes the texel of a nearest fetch from level 0.
BN_FN texel_rows texture_nearest_rows(texture_desc desc, real2 uv)
{
    texture_level level = texture_level_of(desc, int_lit(0));
    real x = texture_wrap(uv.x, desc.wrap_s) * level.width;
    real y = texture_wrap(uv.y, desc.wrap_t) * level.height;
    texel_rows r;
    r.row0 = level.first + (to_int(y) + int_lit(1)) * level.stride + (to_int(x) + int_lit(1));
    r.row1 = r.row0;
    r.w00 = lit(1.0);
    r.w10 = lit(0.0);
    r.w01 = lit(0.0);
    r.w11 = lit(0.0);
    return r;
}

// Taps of a footprint about uv, on two levels each. There are at most p.taps; taps beyond a lane's own number have weight
// 0.
struct texture_taps {
    texture_desc desc;
    texture_level fine, coarse;
    real2 uv, axis;
    real count, each, spacing, f;
};

struct texture_tap {
    texel_rows fine, coarse;
};

BN_FN texture_taps texture_taps_of(texture_desc desc, real2 uv, texture_footprint p)
{
    texture_taps t;
    t.desc = desc;
    integer level = to_int(p.lod);
    t.f = p.lod - to_real(level);
    t.fine = texture_level_of(desc, level);
    t.coarse = texture_level_of(desc, min(level + int_lit(1), int_lit(desc.levels - 1)));
    t.uv = uv;
    t.axis = p.axis;
    t.count = p.taps;
    t.each = lit(1.0) / p.taps;
    t.spacing = lit(1.0) / (p.taps + lit(1.0));
    return t;
}

// Returns tap i, from 0.
BN_FN texture_tap texture_tap_at(BN_IN(texture_taps) t, int i)
{
    real number = to_real(int_lit(i + 1));
    real weight = select(number <= t.count, t.each, lit(0.0));
    real along = number * t.spacing - lit(0.5);
    real2 at = t.uv + t.axis * along;
    real2 wrapped = vec2_of(texture_wrap(at.x, t.desc.wrap_s), texture_wrap(at.y, t.desc.wrap_t));
    real of_coarse = weight * t.f;
    texture_tap tap;
    real of_fine = weight - of_coarse; // named before it is passed: otherwise glslang would not mark it precise
    tap.fine = texture_bilinear_rows(t.fine, wrapped, of_fine);
    tap.coarse = texture_bilinear_rows(t.coarse, wrapped, of_coarse);
    return tap;
}

// Returns the weighted mean over a footprint. max_taps: at least the largest `taps` of all lanes; larger values give the
// same bits, more slowly.
BN_FN real4 texture_sample_footprint(texture_desc desc, real2 uv, texture_footprint p, int max_taps)
{
    if (desc.nearest != 0) {
        return texel_value(texel_rows_add(texel_zero(), desc.texels, texture_nearest_rows(desc, uv)));
    }
    texture_taps taps = texture_taps_of(desc, uv, p);
    texel_acc acc = texel_zero();
    for (int i = 0; i < max_taps; ++i) {
        texture_tap tap = texture_tap_at(taps, i);
        acc = texel_rows_add(acc, desc.texels, tap.fine);
        acc = texel_rows_add(acc, desc.texels, tap.coarse);
    }
    return texel_value(acc);
}

struct texture_one_level { // one level of a pyramid
    texture_desc desc;
    texture_level level;
    real lod; // the level's number
};

// Returns the level nearest to a footprint's lod.
BN_FN texture_one_level texture_one_level_of(texture_desc desc, texture_footprint p)
{
    real nearest = p.lod + lit(0.5);
    integer level = to_int(nearest);
    texture_one_level t;
    t.desc = desc;
    t.level = texture_level_of(desc, level);
    t.lod = to_real(level);
    return t;
}

// Returns a bilinear fetch from one level. uv: not wrapped.
BN_FN real4 texture_sample_level(texture_one_level t, real2 uv)
{
    texel_rows rows;
    if (t.desc.nearest != 0)
        rows = texture_nearest_rows(t.desc, uv);
    else
        rows = texture_bilinear_rows(t.level, vec2_of(texture_wrap(uv.x, t.desc.wrap_s), texture_wrap(uv.y, t.desc.wrap_t)), lit(1.0));
    return texel_value(texel_rows_add(texel_zero(), t.desc.texels, rows));
}

// Returns a filtered fetch at uv, with uv's change per pixel. Takes up to max_taps (uniform, 1 to 16) taps along the
// footprint's longer axis. Lanes get the same bits sooner by texture_footprint_of(), the maximum of `taps` over the lanes,
// and texture_sample_footprint().
BN_FN real4 texture_sample(texture_desc desc, real2 uv, real2 duv_dx, real2 duv_dy, int max_taps)
{
    texture_footprint p = texture_footprint_of(desc, duv_dx, duv_dy, max_taps);
    return texture_sample_footprint(desc, uv, p, max_taps);
}

BN_KERNELS_END
#endif
