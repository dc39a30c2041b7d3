// Clipping of the rare triangle that crosses the near plane or leaves the guard band: Sutherland and Hodgman 1974, "Reentrant Polygon
// Clipping", in homogeneous coordinates. Every cut is computed from the inside to the outside corner, so two triangles that share an edge
// get the same cut whatever their order, and no crack opens. One triangle at a time: all values are uniform.
#ifndef BN_CLIP_T_H
#define BN_CLIP_T_H

#include "shading/kernels/camera.t.h"
#include "shading/lang/frame.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct clip_corner {
    uniform_real c[4];    // clip space x, y, w, z
    uniform_real bary[3]; // of the whole triangle
};

struct clip_polygon {
    int count; // of corners
    clip_corner corner[kMostCorners];
};

// Signed distance to a plane; inside is >= 0. 0: near; 1..4: guard band, where the snapped position would leave its range.
BN_FN uniform_real plane_distance(frame_ref f, BN_IN(clip_corner) v, int plane)
{
    uniform_real gx = float(kCutBand / kSubpixel) / the_frame(f).half_width;
    uniform_real gy = float(kCutBand / kSubpixel) / the_frame(f).half_height;
    uniform_real d = gy * v.c[2] + v.c[1];
    if (plane == 0) {
        uniform_real before_depth = 1.0f - v.c[3];
        uniform_real before_plane = v.c[2] - the_frame(f).view.znear;
        d = the_frame(f).view.orthographic != 0 ? before_depth : before_plane;
    }
    if (plane == 1)
        d = gx * v.c[2] - v.c[0];
    if (plane == 2)
        d = gx * v.c[2] + v.c[0];
    if (plane == 3)
        d = gy * v.c[2] - v.c[1];
    return d;
}

// d_in, d_out: distances of the two to the plane.
BN_FN clip_corner cut_edge(BN_IN(clip_corner) inside, BN_IN(clip_corner) outside, uniform_real d_in, uniform_real d_out)
{
    uniform_real t = d_in / (d_in - d_out);
    clip_corner v;
    for (int i = 0; i < 4; ++i)
        v.c[i] = inside.c[i] + t * (outside.c[i] - inside.c[i]);
    for (int i = 0; i < 3; ++i)
        v.bary[i] = inside.bary[i] + t * (outside.bary[i] - inside.bary[i]);
    return v;
}

// Corner k of a triangle.
BN_FN void set_corner(BN_INOUT(clip_polygon) p, int k, uniform_real x, uniform_real y, uniform_real w, uniform_real z)
{
    p.corner[k].c[0] = x;
    p.corner[k].c[1] = y;
    p.corner[k].c[2] = w;
    p.corner[k].c[3] = z;
    for (int i = 0; i < 3; ++i)
        p.corner[k].bary[i] = i == k ? 1.0f : 0.0f;
}

// What lies inside of a plane.
BN_FN void clip_by_plane(frame_ref f, int plane, BN_INOUT(clip_polygon) p)
{
    clip_polygon left;
    left.count = 0;
    for (int i = 0; i < p.count; ++i) {
        clip_corner a = p.corner[i];
        clip_corner b = p.corner[(i + 1) % p.count];
        uniform_real da = plane_distance(f, a, plane);
        uniform_real db = plane_distance(f, b, plane);
        if (da >= 0.0f) {
            left.corner[left.count] = a;
            left.count = left.count + 1;
        }
        if (da >= 0.0f && db < 0.0f) {
            left.corner[left.count] = cut_edge(a, b, da, db);
            left.count = left.count + 1;
        }
        if (da < 0.0f && db >= 0.0f) {
            left.corner[left.count] = cut_edge(b, a, db, da);
            left.count = left.count + 1;
        }
    }
    for (int i = 0; i < left.count; ++i)
        p.corner[i] = left.corner[i];
    p.count = left.count;
}

// p: a triangle of three corners, of which what is seen is left: a convex polygon, or nothing.
BN_FN void clip_triangle_to_frame(frame_ref f, BN_INOUT(clip_polygon) p)
{
    p.count = 3;
    for (int plane = 0; plane < kClipPlanes; ++plane)
        clip_by_plane(f, plane, p);
}

// On the sub-pixel grid; a cut may come out a rounding error behind the near plane. view: the frame's.
BN_FN snapped_vertex snap_corner(frame_ref f, BN_IN(view_params) view, BN_IN(clip_corner) v)
{
    uniform_real w = v.c[2];
    uniform_real z = v.c[3];
    if (the_frame(f).view.orthographic == 0 && !(w > the_frame(f).view.znear))
        w = the_frame(f).view.znear;
    if (the_frame(f).view.orthographic != 0 && z > 1.0f)
        z = 1.0f;
    return snap_to_frame(f, vec4_of(splat(v.c[0]), splat(v.c[1]), splat(w), splat(z)), view, kGuardBand);
}

// A front face's second and third corner change places, so that its area becomes positive with y down: which corner comes as the j-th.
BN_FN int turned_corner(bool front, int j)
{
    return front && j > 0 ? 3 - j : j;
}

BN_KERNELS_END

#endif
