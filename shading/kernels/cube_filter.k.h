// Seamless trilinear fetches from a bordered cube map. Faces +x (1,-v,-u), -x (-1,-v,u), +y (u,1,v), -y (u,-1,-v), +z
// (u,-v,1), -z (-u,-v,-1) with u, v in [-1,1] along columns and rows: the Vulkan and OpenGL faces.
//
// Memory: RGBA half texels. Level l has t = size >> l texels along an edge, stored as six faces with w x w texels, w = t +
// 2, rows from the top. One texel of the neighbouring faces surrounds each face; corner texels are the mean of three faces.
// So a 2x2 footprint never leaves its face, and both faces of an edge interpolate to the same colour there. Levels follow
// each other, largest first, without gaps. Sizes halve exactly, so the total size of the levels before level l has a closed
// form,
//    6 * (sum of w^2) = 8 (w0^2 + 2 w0) - 8 (w^2 + 2 w) + 24 l,    w0 = size + 2.
// The index of texel (ix, iy) in a face, border included, is
//    8 (w0^2 + 2 w0) + 24 l + w ((face - 8) w + iy - 16) + ix:
// two integer products and no table.
#ifndef BN_CUBE_FILTER_K_H
#define BN_CUBE_FILTER_K_H
#include "shading/kernels/math.k.h"
#include "shading/kernels/texel_rows.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct cube_desc { // uniform
    texel_buffer texels;
    int size;   // texels along an edge of level 0, a power of two
    int levels; // at least 1; size >> (levels - 1) is at least 1
};

struct cube_place {
    integer face; // 0 to 5: +x -x +y -y +z -z
    real u;       // [0, 1], along the row
    real v;       // [0, 1], along the column
};

// Returns where direction d (any length) meets the cube. Ties between axes go to x before y before z. The zero vector gives
// the middle of +z; a NaN component gives some place inside the cube.
BN_FN cube_place cube_face_uv(real3 d)
{
    // Find the major axis and its sign
    real ax = abs(d.x);
    real ay = abs(d.y);
    real az = abs(d.z);
    real m = max(az, max(ay, max(ax, lit(1e-30)))); // a NaN never passes: max(NaN, b) is b
    mask is_x = ax >= m;
    mask is_y = ay >= m;
    real of_yz = select(is_y, d.y, d.z);
    // Project the other two components
    real major = select(is_x, d.x, of_yz);
    mask negative = major < lit(0.0);
    real inv = lit(0.5) / m;
    real minus_inv = -inv;
    real inv_signed = select(negative, minus_inv, inv);
    mask y_face = both(is_y, not_(is_x));
    real a = select(is_x, -d.z, d.x);
    real b = select(y_face, d.z, d.y);
    real a_scale = select(y_face, inv, inv_signed);
    real b_scale = select(y_face, inv_signed, minus_inv);
    cube_place p;
    // |a|, |b| <= m, so only rounding exceeds 1, and stays in the border; max() drops NaN
    p.u = max(a * a_scale + lit(0.5), lit(0.0));
    p.v = max(b * b_scale + lit(0.5), lit(0.0));
    integer axis_yz = select(y_face, int_lit(2), int_lit(4));
    integer axis = select(is_x, int_lit(0), axis_yz);
    p.face = axis + select(negative, int_lit(1), int_lit(0));
    return p;
}

// Computes a bilinear fetch times weight at `place`. t (a real), w = t + 2 (an integer): texels along the level's edge.
// base = 8 (w0^2 + 2 w0) + 24 level.
BN_FN texel_rows cube_bilinear_rows(cube_place place, integer base, integer w, real t, real weight)
{
    real x = place.u * t + lit(0.5);
    real y = place.v * t + lit(0.5);
    integer ix = to_int(x);
    integer iy = to_int(y);
    real fx = x - to_real(ix);
    real fy = y - to_real(iy);
    texel_rows r;
    r.row0 = base + ix + w * ((place.face - int_lit(8)) * w + (iy - int_lit(16)));
    r.row1 = r.row0 + w;
    real lower = weight * fy;
    real upper = weight - lower;
    r.w10 = upper * fx;
    r.w11 = lower * fx;
    r.w00 = upper - r.w10;
    r.w01 = lower - r.w11;
    return r;
}

BN_FN integer cube_base(cube_desc cube)
{
    return int_lit(8 * ((cube.size + 2) * (cube.size + 2) + 2 * (cube.size + 2)));
}

// Computes a bilinear fetch at a uniform level in [0, levels - 1].
BN_FN texel_rows cube_level_rows(cube_desc cube, cube_place place, int level, real weight)
{
    integer t = int_lit(cube.size >> level);
    return cube_bilinear_rows(place, cube_base(cube) + int_lit(24 * level), t + int_lit(2), to_real(t), weight);
}

// Computes a bilinear fetch at a level that varies by direction.
BN_FN texel_rows cube_own_level_rows(cube_desc cube, cube_place place, integer level, real weight)
{
    real size = to_real(int_lit(cube.size));
    real t = real_from_bits(bits_of(size) - shl(level, 23)); // the exponent lowered by the level
    return cube_bilinear_rows(place, cube_base(cube) + level * int_lit(24), to_int(t) + int_lit(2), t, weight);
}

BN_FN texel_acc cube_level_add(texel_acc acc, cube_desc cube, cube_place place, int level, real weight)
{
    return texel_rows_add(acc, cube.texels, cube_level_rows(cube, place, level, weight));
}

// Two neighbouring levels of a cube with at least two, and their weights.
struct cube_levels {
    integer base; // the finer level's
    integer w;
    real t;
    real fine, coarse;
};

// Returns the levels at lod, clamped to [0, levels - 1]; NaN counts as 0.
BN_FN cube_levels cube_levels_at(cube_desc cube, real lod, real weight)
{
    real last = to_real(int_lit(cube.levels - 1));
    real clamped = min(max(lod, lit(0.0)), last);
    integer level = min(to_int(clamped),
                        int_lit(cube.levels - 2)); // the finer of two; the last level is reached with f = 1
    real f = clamped - to_real(level);
    // Size of level 0 as a float, its exponent lowered by the level
    real size = to_real(int_lit(cube.size));
    cube_levels l;
    l.t = real_from_bits(bits_of(size) - shl(level, 23));
    l.w = to_int(l.t) + int_lit(2);
    l.base = cube_base(cube) + level * int_lit(24);
    l.coarse = weight * f;
    l.fine = weight - l.coarse;
    return l;
}

BN_FN texel_rows cube_fine_rows(cube_place place, cube_levels l)
{
    return cube_bilinear_rows(place, l.base, l.w, l.t, l.fine);
}

BN_FN texel_rows cube_coarse_rows(cube_place place, cube_levels l)
{
    real t = l.t * lit(0.5);
    return cube_bilinear_rows(place, l.base + int_lit(24), shr(l.w, 1) + int_lit(1), t, l.coarse);
}

// Adds weight times the trilinear value in direction d, any length. lod as above.
BN_FN texel_acc cube_texel_add(texel_acc acc, cube_desc cube, real3 d, real lod, real weight)
{
    cube_place place = cube_face_uv(d);
    if (cube.levels == 1) {
        return cube_level_add(acc, cube, place, 0, weight);
    }
    cube_levels l = cube_levels_at(cube, lod, weight);
    texel_acc sum = texel_rows_add(acc, cube.texels, cube_fine_rows(place, l));
    return texel_rows_add(sum, cube.texels, cube_coarse_rows(place, l));
}

// Returns one trilinear fetch.
BN_FN real3 cube_sample(cube_desc cube, real3 d, real lod)
{
    texel_acc acc = texel_zero();
    real4 value = texel_value(cube_texel_add(acc, cube, d, lod, lit(1.0)));
    return vec3_of(value.x, value.y, value.z);
}

// Returns one bilinear fetch from a uniform level.
BN_FN real3 cube_sample_level(cube_desc cube, real3 d, int level)
{
    texel_acc acc = texel_zero();
    real4 value = texel_value(cube_level_add(acc, cube, cube_face_uv(d), level, lit(1.0)));
    return vec3_of(value.x, value.y, value.z);
}

// Returns one bilinear fetch from a level that varies by direction.
BN_FN real3 cube_sample_own_level(cube_desc cube, real3 d, integer level)
{
    texel_acc acc = texel_zero();
    real4 value = texel_value(texel_rows_add(acc, cube.texels, cube_own_level_rows(cube, cube_face_uv(d), level, lit(1.0))));
    return vec3_of(value.x, value.y, value.z);
}

BN_KERNELS_END
#endif
