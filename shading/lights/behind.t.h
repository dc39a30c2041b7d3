// Opaque surfaces behind transmissive bodies, from a picture of the frame without these bodies. A ray is followed over the picture until
// it passes behind a surface.
#ifndef BN_BEHIND_T_H
#define BN_BEHIND_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/camera.t.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

const int kBehindSteps = 24;      // places along a ray; the last one is nearly at infinity
const float kBehindMargin = 0.5f; // in the picture's widths and heights: surfaces at its edges continue so far, and fade
const int kBehindCuts = 3;        // by which the place is bisected where the ray meets a surface

// A ray over the picture.
struct behind_ray {
    real3 from, way; // origin relative to the eye, and unit direction; metres
    real scale;      // metres to the middle one of its places
};

// A place of a ray, as the picture shows it.
struct behind_place {
    real2 uv;          // of the picture, [0,1] inside
    real z;            // metres along the view direction
    real depth;        // 1 / z, 1/m
    mask near_picture; // in front of the eye and not far beside the picture
};

// Returns the distance of a place along a ray. s: [0,1].
BN_FN real behind_distance(BN_IN(behind_ray) r, real s)
{
    return r.scale * s / max(lit(1.0) - s, lit(1e-3));
}

// Returns the distance of a place from the picture, in its widths or heights; 0: inside.
BN_FN real beside_picture(real2 uv)
{
    real across = max(-uv.x, uv.x - lit(1.0));
    real down = max(-uv.y, uv.y - lit(1.0));
    return max(max(across, down), lit(0.0));
}

BN_FN behind_place behind_place_at(BN_IN(view_params) view, BN_IN(behind_ray) r, real distance)
{
    real3 at = r.from + r.way * distance;
    behind_place p;
    p.z = k_dot3(view.forward, at);
    mask front = p.z > view.znear;
    p.depth = lit(1.0) / select(front, p.z, lit(1.0));
    real scale = select(view.orthographic, lit(1.0), p.depth) * lit(0.5);
    p.uv = vec2_of(lit(0.5) + k_dot3(view.right, at) * view.inv_tan_x * scale, lit(0.5) - k_dot3(view.up, at) * view.inv_tan_y * scale);
    p.near_picture = both(front, beside_picture(p.uv) < splat(kBehindMargin));
    return p;
}

// Returns the inverse depth of the opaque surface at uv, 1/m; 0: none.
BN_FN real depth_behind(frame_ref f, real2 uv)
{
    texture_one_level whole;
    whole.desc = texture_of_frame(f, the_frame(f).behind + 1);
    whole.level = texture_level_of(whole.desc, int_lit(0));
    whole.lod = lit(0.0);
    return texture_sample_level(whole, uv).x;
}

// Returns how far a place lies behind the surface at its uv, as a difference of inverse depths, 1/m; below 0: in front.
BN_FN real behind_by(frame_ref f, BN_IN(behind_place) p)
{
    return select(p.near_picture, depth_behind(f, p.uv) - p.depth, lit(-1.0));
}

// The picture at a place of a ray.
struct behind_fetch {
    real4 light; // times coverage, and coverage
    real fade;   // [0,1]: 1 inside the picture, 0 far beside it
    real wide;   // [0,1]: 0 for a ray of less than two pixels, 1 from eight on
};

// Fetches at the ray's width.
BN_FN behind_fetch fetch_behind(frame_ref f, BN_IN(view_params) view, BN_IN(behind_ray) ray, real distance, real start, real spread)
{
    behind_place p = behind_place_at(view, ray, distance);
    real width = start + spread * distance;
    real pixel = select(view.orthographic, lit(1.0), p.z) / (view.inv_tan_y * splat(the_frame(f).half_height));
    texture_desc picture = texture_of_frame(f, the_frame(f).behind);
    texture_footprint footprint;
    footprint.lod = min(max(k_log2(width / max(pixel, lit(1e-20))), lit(0.0)), to_real(int_lit(picture.levels - 1)));
    footprint.taps = lit(1.0);
    footprint.axis = vec2_all(lit(0.0));
    real fade = min(max(width / max(pixel * splat(the_frame(f).half_height), lit(1e-20)), lit(0.125)), splat(kBehindMargin));
    behind_fetch r;
    r.light = texture_sample_footprint(picture, p.uv, footprint, 1);
    r.fade = select(p.near_picture, k_saturate(lit(1.0) - beside_picture(p.uv) / fade), lit(0.0));
    r.wide = k_saturate(footprint.lod * lit(0.5) - lit(0.5));
    return r;
}

// Returns the light of opaque surfaces along a ray, times their coverage, and their coverage, [0,1]. from: world space. way: unit. start:
// the ray's footprint where it starts, metres; spread: its growth per metre.
BN_STAGE real4 surfaces_behind(any_frame f, BN_IN(real3) from, BN_IN(real3) way, real start, real spread)
{
    view_params view = view_params_of(the_frame(f).view);
    behind_ray ray;
    ray.from = from - view.eye;
    ray.way = way;
    ray.scale = k_length3(ray.from) * lit(0.5);
    // Find the first place behind a surface
    real step = lit(1.0) / to_real(int_lit(kBehindSteps));
    real last = lit(0.0);
    real low = lit(-1.0);
    real high = lit(0.0);
    mask open = ray.scale >= lit(0.0);
    for (int i = 0; i <= kBehindSteps; ++i) {
        real s = to_real(int_lit(i)) * step;
        real distance = behind_distance(ray, s);
        behind_place p = behind_place_at(view, ray, distance);
        real by = behind_by(f, p);
        // Skip surfaces far before the ray, which it passes behind
        real surface_z = lit(1.0) / max(by + p.depth, lit(1e-9));
        mask near_it = p.z - surface_z < (distance - last) * lit(3.0) + p.z * lit(0.02);
        mask meets = both(both(open, by > lit(0.0)), near_it);
        low = select(meets, last, low);
        high = select(meets, distance, high);
        open = both(open, not_(meets));
        last = select(open, distance, last);
    }
    // Bisect; a ray that meets nothing ends at infinity
    mask found = not_(open);
    real farthest = behind_distance(ray, lit(1.0));
    low = select(found, low, farthest);
    high = select(found, high, farthest);
    for (int i = 0; i < kBehindCuts; ++i) {
        real middle = (low + high) * lit(0.5);
        mask behind = behind_by(f, behind_place_at(view, ray, middle)) > lit(0.0);
        high = select(behind, middle, high);
        low = select(behind, low, middle);
    }
    // Meet the line between both depths
    real before = min(behind_by(f, behind_place_at(view, ray, low)), lit(0.0));
    real after = max(behind_by(f, behind_place_at(view, ray, high)), lit(0.0));
    real distance = low + (high - low) * (before / min(before - after, lit(-1e-12)));
    // Fetch where it meets a surface. A wide ray shows the surface from half coverage on, in full at whole coverage, so that the surface
    // appears without a line
    behind_fetch met = fetch_behind(f, view, ray, distance, start, spread);
    real covered = max(met.light.w, lit(1e-6));
    real edge = k_saturate(lit(2.0) * covered - lit(1.0)) / covered;
    real share = select(found, lit(1.0) + (edge - lit(1.0)) * met.wide, lit(0.0));
    real4 light = met.light * (share * met.fade);
    // The uncovered rest of a wide ray shows the surfaces around the ray's end
    behind_fetch end = fetch_behind(f, view, ray, farthest, start, spread);
    return light + end.light * (end.fade * end.wide * (lit(1.0) - light.w));
}

BN_KERNELS_END

#endif
