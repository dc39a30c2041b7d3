// Filtering of a light's picture for textured parallelograms: picks the texels that a transformed cosine covers. After
// Heitz, Dupuy, Hill, Neubelt 2016, section 5. Their single fetch is round in the cosine's space, so a long lobe makes it a
// long ellipse in the picture. Here a row of fetches lies along that ellipse.
#ifndef BN_LTC_TEXTURE_K_H
#define BN_LTC_TEXTURE_K_H
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/lights/ltc_table.k.h"

BN_KERNELS_BEGIN

const float kLtcTextureReach = 0.6f;

struct ltc_texture_row {
    real2 uv;       // the row's middle; (0,0) at the first corner, u towards the second, v towards the last; [0,1]
    real2 half_row; // from the middle to the row's ends, which lie in [0,1] too
    real level;     // mip level of the picture
};

// Returns how many lengths of a step (texels) a place can move both ways inside [0,1].
BN_FN real ltc_row_room(real place, real step, real texels)
{
    real side = min(place, lit(1.0) - place) * texels;
    return side / max(abs(step), lit(1e-6));
}

// Returns the mean direction of a light's share of the cosine. The flow's direction weights all directions equally; the
// mean under the cosine lies nearer to the normal. Exact for a cone as wide as the flow is long.
BN_FN real3 ltc_texture_way(real3 flow)
{
    real size = min(k_length3(flow), lit(1.0));
    real3 f = flow / max(size, lit(1e-15));
    real cosine = sqrt(lit(1.0) - size); // cosine of the cone's radius
    // The cone's second moments along and across the axis, over 2 pi (1 - cosine), which would lose its digits for small
    // cones
    real forth = (lit(1.0) + cosine + cosine * cosine) * lit(0.33333333333333333);
    real aside = size / (lit(1.0) + cosine) * (lit(2.0) + cosine) * lit(0.16666666666666667);
    real along = f.z * (forth - aside);
    real3 way = f * along + vec3_of(lit(0.0), lit(0.0), aside);
    return select(f.z > lit(0.0), way, f);
}

// Computes the row of fetches. Its middle is where the light comes from. At distance r in the cosine's space, light spreads
// over r kLtcTextureReach (standard deviation) around the middle. flow: from ltc_light; corner: the first; side_u, side_v:
// from there, in the lobe's axes; width, height: texels of level 0; spread: kLightPictureSpread; last: the coarsest level,
// the result where there is no flow.
BN_FN ltc_texture_row ltc_texture_row_of(BN_IN(ltc_lobe) lobe, real3 flow, real3 corner, real3 side_u, real3 side_v, real width,
                                         real height, real spread, int taps, real last)
{
    // Intersect the mean direction with the light's plane
    real3 normal = k_cross(side_u, side_v);
    real3 way = ltc_texture_way(flow);
    real3 d = lobe.m0 * way.x + lobe.m1 * way.y + lobe.m2 * way.z;
    real towards = k_dot3(d, normal);
    real distance = k_dot3(corner, normal);
    mask met = abs(towards) > lit(1e-30);
    real along = select(met, distance, lit(0.0)) / select(met, towards, lit(1.0));
    real3 at = d * along - corner;
    real area2 = max(k_dot3(normal, normal), lit(1e-30));
    real u = k_saturate(k_dot3(k_cross(at, side_v), normal) / area2);
    real v = k_saturate(k_dot3(k_cross(side_u, at), normal) / area2);
    // Express texels in the cosine's space. A round footprint there is longest where texels are short.
    real3 a = ltc_to_cosine(lobe, side_u) / width;
    real3 b = ltc_to_cosine(lobe, side_v) / height;
    real3 across = ltc_normal_to_cosine(lobe, normal) / (lobe.det * width * height); // a x b, with more digits
    real aa = k_dot3(a, a);
    real bb = k_dot3(b, b);
    real ab = k_dot3(a, b);
    // Find the footprint's axes
    real half_sum = lit(0.5) * (aa + bb);
    real half_gap = lit(0.5) * (aa - bb);
    real root = sqrt(half_gap * half_gap + ab * ab);
    real most = max(half_sum + root, lit(1e-30));
    real least = max(k_dot3(across, across) / most, lit(1e-30));
    mask u_short = half_gap >= lit(0.0); // so the axis is nearer to v
    real larger = abs(half_gap) + root;
    real2 axis = vec2_of(select(u_short, -ab, larger), select(u_short, larger, -ab));
    axis = axis / sqrt(max(k_dot2(axis, axis), lit(1e-30)));
    // Choose the row's length and level
    real reach = splat(kLtcTextureReach) * k_length3(way) * abs(along);
    real narrow = reach / sqrt(most);
    real wide = reach / sqrt(least);
    real gap = max(wide * wide - narrow * narrow, lit(0.0));
    real room = min(ltc_row_room(u, axis.x, width), ltc_row_room(v, axis.y, height));
    real half_row = min(sqrt(lit(3.0) * gap), room); // a uniform row's deviation is half its length over root 3
    real each = max(narrow, half_row / to_real(int_lit(taps)));
    ltc_texture_row r;
    r.uv = vec2_of(select(met, u, lit(0.5)), select(met, v, lit(0.5)));
    r.half_row = select(met, vec2_of(axis.x * half_row / width, axis.y * half_row / height), vec2_all(lit(0.0)));
    real level = k_log2(max(each / spread, lit(1.0)));
    r.level = select(met, min(level, last), last);
    return r;
}

BN_KERNELS_END
#endif
