// Which texels of a light's picture stand for the part of a transformed cosine that a textured parallelogram takes. After Heitz, Dupuy,
// Hill, Neubelt 2016, section 5, whose one fetch is round in the cosine's space and so, by a lobe that is long, a long ellipse of the
// picture: here a row of fetches lies along that.
#ifndef BN_LTC_TEXTURE_K_H
#define BN_LTC_TEXTURE_K_H
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/lights/ltc_table.k.h"

BN_KERNELS_BEGIN

const float kLtcTextureReach = 0.6f;

struct ltc_texture_row {
    real2 uv;       // its middle; (0,0) at the first corner, u towards the second, v towards the last; [0,1]
    real2 half_row; // from there to its ends, which lie in [0,1] too
    real level;     // of the picture's levels
};

// How far a step (texels) from a place can go both ways before it leaves [0,1]: by so many of its lengths.
BN_FN real ltc_row_room(real place, real step, real texels)
{
    real side = min(place, lit(1.0) - place) * texels;
    return side / max(abs(step), lit(1e-6));
}

// Where a light's part of a cosine comes from: not in the mean the direction of its flow, in which all of its directions count alike, but
// nearer to the normal. Of a cone as wide as the flow is long, exactly.
BN_FN real3 ltc_texture_way(real3 flow)
{
    real size = min(k_length3(flow), lit(1.0));
    real3 f = flow / max(size, lit(1e-15));
    real cosine = sqrt(lit(1.0) - size); // of the cone's radius
    // its second moments along the axis and across it, over 2 pi times 1 - cosine, which has no digits of small cones
    real forth = (lit(1.0) + cosine + cosine * cosine) * lit(0.33333333333333333);
    real aside = size / (lit(1.0) + cosine) * (lit(2.0) + cosine) * lit(0.16666666666666667);
    real along = f.z * (forth - aside);
    real3 way = f * along + vec3_of(lit(0.0), lit(0.0), aside);
    return select(f.z > lit(0.0), way, f);
}

// The middle of the row is where the light comes from. At distance r in the cosine's space light of about r kLtcTextureReach comes from
// there (standard deviation). flow: of ltc_light; corner: the first; side_u, side_v: from there, in the lobe's axes; width, height: texels
// of level 0; spread: kLightPictureSpread; last: the coarsest level, which is the answer where there is no flow.
BN_FN ltc_texture_row ltc_texture_row_of(BN_IN(ltc_lobe) lobe, real3 flow, real3 corner, real3 side_u, real3 side_v, real width,
                                         real height, real spread, int taps, real last)
{
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
    // Texels in the cosine's space: the longer axis of what is round there is where they are short.
    real3 a = ltc_to_cosine(lobe, side_u) / width;
    real3 b = ltc_to_cosine(lobe, side_v) / height;
    real3 across = ltc_normal_to_cosine(lobe, normal) / (lobe.det * width * height); // a x b, with more digits
    real aa = k_dot3(a, a);
    real bb = k_dot3(b, b);
    real ab = k_dot3(a, b);
    real half_sum = lit(0.5) * (aa + bb);
    real half_gap = lit(0.5) * (aa - bb);
    real root = sqrt(half_gap * half_gap + ab * ab);
    real most = max(half_sum + root, lit(1e-30));
    real least = max(k_dot3(across, across) / most, lit(1e-30));
    mask u_short = half_gap >= lit(0.0); // so the axis is nearer to v
    real larger = abs(half_gap) + root;
    real2 axis = vec2_of(select(u_short, -ab, larger), select(u_short, larger, -ab));
    axis = axis / sqrt(max(k_dot2(axis, axis), lit(1e-30)));
    real reach = splat(kLtcTextureReach) * k_length3(way) * abs(along);
    real narrow = reach / sqrt(most);
    real wide = reach / sqrt(least);
    real gap = max(wide * wide - narrow * narrow, lit(0.0));
    real room = min(ltc_row_room(u, axis.x, width), ltc_row_room(v, axis.y, height));
    real half_row = min(sqrt(lit(3.0) * gap), room); // an even row's deviation is its half over root 3
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
