// Radiance of area lights; quads may have a picture. At a point of a light, or as a mean over the part that a transformed
// cosine covers.
#ifndef BN_AREA_PICTURE_T_H
#define BN_AREA_PICTURE_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/lights/area_point.t.h"
#include "shading/lights/ltc_texture.k.h"

BN_KERNELS_BEGIN

// Returns the picture's coordinates for a place along a quad's sides, which its node may have mirrored.
BN_FN real2 picture_uv(frame_ref f, int light, real2 along)
{
    if (the_area_light(f, light).transposed != 0)
        return vec2_of(along.y, lit(1.0) - along.x);
    return vec2_of(along.x, lit(1.0) - along.y);
}

// Returns radiance for a texel, stored as its difference from the picture's mean.
BN_FN real3 picture_radiance(frame_ref f, int light, real4 difference)
{
    real3 texel = splat3(the_area_light(f, light).mean) + vec3_of(difference.x, difference.y, difference.z);
    return splat3(the_area_light(f, light).radiance) * max(texel, vec3_all(lit(0.0)));
}

// Returns radiance towards the side that shines. at: a point of the light, world space.
BN_STAGE real3 area_radiance_at(any_frame f, int light, BN_IN(real3) at)
{
    if (the_area_light(f, light).picture < 0)
        return splat3(the_area_light(f, light).radiance);
    // Find the point's coordinates along the sides
    real3 corner = area_point(f, light, 0);
    real3 side_u = area_point(f, light, 1) - corner;
    real3 side_v = area_point(f, light, 3) - corner;
    real3 normal = k_cross(side_u, side_v);
    real3 place = at - corner;
    real area2 = max(k_dot3(normal, normal), lit(1e-30));
    real u = k_dot3(k_cross(place, side_v), normal) / area2;
    real v = k_dot3(k_cross(side_u, place), normal) / area2;
    // Fetch from level 0
    texture_one_level whole;
    whole.desc = picture_of(f, light);
    whole.level = texture_level_of(whole.desc, int_lit(0));
    whole.lod = lit(0.0);
    return picture_radiance(f, light, texture_sample_level(whole, picture_uv(f, light, vec2_of(u, v))));
}

// Returns the mean radiance over the lobe's share of the light. corner, side_u, side_v: the light's first corner, and the
// vectors from there to the second and the last, in the lobe's axes; flow: from ltc_light.
BN_STAGE real3 area_radiance_through(any_frame f, int light, BN_IN(ltc_lobe) lobe, BN_IN(real3) flow, BN_IN(real3) corner,
                                     BN_IN(real3) side_u, BN_IN(real3) side_v)
{
    if (the_area_light(f, light).picture < 0)
        return splat3(the_area_light(f, light).radiance);
    // Read the picture's size, as its sides lie on the quad
    texture_desc picture = picture_of(f, light);
    real along_s = table_value(picture.level_width, int_lit(0));
    real along_t = table_value(picture.level_height, int_lit(0));
    bool transposed = the_area_light(f, light).transposed != 0;
    real width = transposed ? along_t : along_s;
    real height = transposed ? along_s : along_t;
    real last = to_real(int_lit(picture.levels - 1));
    // Place a row of fetches
    ltc_texture_row row =
        ltc_texture_row_of(lobe, flow, corner, side_u, side_v, width, height, splat(kLightPictureSpread), kLightPictureTaps, last);
    real2 middle = picture_uv(f, light, row.uv);
    real2 end = picture_uv(f, light, row.uv + row.half_row);
    texture_footprint footprint;
    footprint.lod = row.level;
    footprint.taps = to_real(int_lit(kLightPictureTaps));
    // texture_tap_at() places the last tap at (taps - 1) / (2 (taps + 1)) of the axis. Scale the axis so that this equals
    // the same share of half a row over its taps.
    footprint.axis = (end - middle) * (lit(2.0) + lit(2.0) / footprint.taps);
    return picture_radiance(f, light, texture_sample_footprint(picture, middle, footprint, kLightPictureTaps));
}

BN_KERNELS_END

#endif
