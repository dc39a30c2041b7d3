// Clipping of the rare triangle that crosses the near plane or leaves the guard band: Sutherland and Hodgman 1974,
// "Reentrant Polygon Clipping", in homogeneous coordinates and double precision. Corners may lie millions of near-plane
// distances away, so floats would lose a cut's w. A cut lies exactly on its plane, so every remaining corner has a place on
// the grid and no piece is lost to rounding. Every cut runs from the inside to the outside corner. So two triangles that
// share an edge get the same cut in either order, and no crack opens. Clips one triangle at a time: all values are uniform.
#ifndef BN_CLIP_T_H
#define BN_CLIP_T_H

#include "shading/kernels/camera.t.h"
#include "shading/lang/frame.h"
#include "shading/lang/lang.h"
#include "shading/lang/wide.h"

BN_KERNELS_BEGIN

struct clip_corner {
    uniform_wide c[4];    // clip space x, y, w, z
    uniform_wide bary[3]; // barycentrics in the whole triangle
    bool placed;          // x to z are set
    int x, y;             // 1/256 pixel, as snapped_vertex
    uniform_real inv_w, z;
};

struct clip_polygon {
    int count; // number of corners
    clip_corner corner[kMostCorners];
};

// Returns the guard band's |x| / w and |y| / w.
BN_FN uniform_wide band_x(frame_ref f)
{
    return wide_of(kCutBand / kSubpixel) / wide_of(the_frame(f).half_width);
}
BN_FN uniform_wide band_y(frame_ref f)
{
    return wide_of(kCutBand / kSubpixel) / wide_of(the_frame(f).half_height);
}

// Returns the guard band's middle, as band_x() and band_y(). y up.
BN_FN uniform_wide middle_x(frame_ref f)
{
    return wide_of(the_frame(f).middle_x);
}
BN_FN uniform_wide middle_y(frame_ref f)
{
    return -wide_of(the_frame(f).middle_y);
}

// Returns the signed distance to a plane; inside is >= 0. Plane 0: near; 1 to 4: guard band.
BN_FN uniform_wide plane_distance(frame_ref f, BN_IN(clip_corner) v, int plane)
{
    uniform_wide d = (band_y(f) - middle_y(f)) * v.c[2] + v.c[1];
    // Distance to the near plane, by depth for orthographic views
    if (plane == 0) {
        uniform_wide before_depth = wide_of(1) - v.c[3];
        uniform_wide before_plane = v.c[2] - wide_of(the_frame(f).view.znear);
        d = before_plane;
        if (the_frame(f).view.orthographic != 0)
            d = before_depth;
    }
    // Distances to the guard band's sides
    if (plane == 1)
        d = (band_x(f) + middle_x(f)) * v.c[2] - v.c[0];
    if (plane == 2)
        d = (band_x(f) - middle_x(f)) * v.c[2] + v.c[0];
    if (plane == 3)
        d = (band_y(f) + middle_y(f)) * v.c[2] - v.c[1];
    return d;
}

// Sets the coordinate that a plane fixes.
BN_FN void put_on_plane(frame_ref f, int plane, BN_INOUT(clip_corner) v)
{
    if (plane == 0 && the_frame(f).view.orthographic == 0)
        v.c[2] = wide_of(the_frame(f).view.znear);
    if (plane == 0 && the_frame(f).view.orthographic != 0)
        v.c[3] = wide_of(1);
    if (plane == 1)
        v.c[0] = (middle_x(f) + band_x(f)) * v.c[2];
    if (plane == 2)
        v.c[0] = (middle_x(f) - band_x(f)) * v.c[2];
    if (plane == 3)
        v.c[1] = (middle_y(f) + band_y(f)) * v.c[2];
    if (plane == 4)
        v.c[1] = (middle_y(f) - band_y(f)) * v.c[2];
}

// Returns the point where an edge meets a plane. d_in, d_out: distances of the edge's ends to the plane.
BN_FN clip_corner cut_edge(frame_ref f, int plane, BN_IN(clip_corner) inside, BN_IN(clip_corner) outside, uniform_wide d_in,
                           uniform_wide d_out)
{
    // Interpolate position and barycentrics
    uniform_wide t = d_in / (d_in - d_out);
    clip_corner v = inside;
    for (int i = 0; i < 4; ++i)
        v.c[i] = inside.c[i] + t * (outside.c[i] - inside.c[i]);
    for (int i = 0; i < 3; ++i)
        v.bary[i] = inside.bary[i] + t * (outside.bary[i] - inside.bary[i]);
    // Move the cut exactly onto the plane
    v.placed = false;
    put_on_plane(f, plane, v);
    return v;
}

// Sets corner k from its world position: clip_position() in double precision.
BN_FN void set_corner(frame_ref f, BN_INOUT(clip_polygon) p, int k, uniform_real x, uniform_real y, uniform_real z)
{
    // Transform to view space
    uniform_wide dx = wide_of(x) - wide_of(the_frame(f).view.eye[0]);
    uniform_wide dy = wide_of(y) - wide_of(the_frame(f).view.eye[1]);
    uniform_wide dz = wide_of(z) - wide_of(the_frame(f).view.eye[2]);
    uniform_wide across =
        wide_of(the_frame(f).view.right[0]) * dx + wide_of(the_frame(f).view.right[1]) * dy + wide_of(the_frame(f).view.right[2]) * dz;
    uniform_wide height =
        wide_of(the_frame(f).view.up[0]) * dx + wide_of(the_frame(f).view.up[1]) * dy + wide_of(the_frame(f).view.up[2]) * dz;
    uniform_wide depth = wide_of(the_frame(f).view.forward[0]) * dx + wide_of(the_frame(f).view.forward[1]) * dy +
                         wide_of(the_frame(f).view.forward[2]) * dz;
    // Project to clip space
    p.corner[k].c[0] = across * wide_of(the_frame(f).view.inv_tan_x);
    p.corner[k].c[1] = height * wide_of(the_frame(f).view.inv_tan_y);
    p.corner[k].c[2] = depth;
    p.corner[k].c[3] = wide_of(the_frame(f).view.znear);
    if (the_frame(f).view.orthographic != 0) {
        p.corner[k].c[2] = wide_of(1);
        p.corner[k].c[3] = (wide_of(the_frame(f).view.zfar) - depth) * wide_of(the_frame(f).view.inv_depth);
    }
    // Start with a vertex of the whole triangle
    for (int i = 0; i < 3; ++i)
        p.corner[k].bary[i] = wide_of(i == k ? 1 : 0);
    p.corner[k].placed = false;
}

// Sets corner k's snapped place, which its neighbours use too.
BN_FN void place_corner(BN_INOUT(clip_polygon) p, int k, int x, int y, uniform_real inv_w, uniform_real z)
{
    p.corner[k].placed = true;
    p.corner[k].x = x;
    p.corner[k].y = y;
    p.corner[k].inv_w = inv_w;
    p.corner[k].z = z;
}

// Clips a polygon to the inside of a plane.
BN_FN void clip_by_plane(frame_ref f, int plane, BN_INOUT(clip_polygon) p)
{
    clip_polygon left;
    left.count = 0;
    // Visit the edges in order
    for (int i = 0; i < p.count; ++i) {
        clip_corner a = p.corner[i];
        clip_corner b = p.corner[(i + 1) % p.count];
        // Treat a placed corner as inside, although it may lie a float rounding error behind the near plane.
        uniform_wide da = plane_distance(f, a, plane);
        uniform_wide db = plane_distance(f, b, plane);
        if (a.placed)
            da = wide_max(da, wide_of(0));
        if (b.placed)
            db = wide_max(db, wide_of(0));
        // Keep an inside corner, and cut an edge that crosses the plane
        if (da >= wide_of(0)) {
            left.corner[left.count] = a;
            left.count = left.count + 1;
        }
        if (da >= wide_of(0) && db < wide_of(0)) {
            left.corner[left.count] = cut_edge(f, plane, a, b, da, db);
            left.count = left.count + 1;
        }
        if (da < wide_of(0) && db >= wide_of(0)) {
            left.corner[left.count] = cut_edge(f, plane, b, a, db, da);
            left.count = left.count + 1;
        }
    }
    // Return the remaining corners
    for (int i = 0; i < left.count; ++i)
        p.corner[i] = left.corner[i];
    p.count = left.count;
}

// Returns a place on the grid. place: -1 to 1 over the image; half_size: pixels; center: as snap_vertex().
BN_FN int place_on_grid(uniform_wide place, uniform_real half_size, int center)
{
    // Map to 1/256 pixel, and clamp to the guard band
    uniform_wide at = (place * wide_of(half_size) + wide_of(half_size)) * wide_of(kSubpixel) - wide_of(center);
    uniform_wide most = wide_of(kGuardBand - 1);
    uniform_wide least = wide_of(1 - kGuardBand);
    at = wide_min(wide_max(at, least), most);
    // Round to the nearest integer
    uniform_wide positive = at + (wide_of(kGuardBand) + wide_of(0.5f));
    return int(positive) - kGuardBand;
}

// Snaps a corner that has no place yet.
BN_FN void snap_corner(frame_ref f, BN_INOUT(clip_corner) v)
{
    // Clamp w and depth, so that depth is at most 1
    uniform_wide w = v.c[2];
    uniform_wide z = v.c[3];
    if (the_frame(f).view.orthographic == 0)
        w = wide_max(w, wide_of(the_frame(f).view.znear));
    z = wide_min(z, w);
    // Project and snap
    uniform_wide x = v.c[0] / w;
    uniform_wide y = -v.c[1] / w;
    v.x = place_on_grid(x, the_frame(f).half_width, center_in_picture_x(f));
    v.y = place_on_grid(y, the_frame(f).half_height, center_in_picture_y(f));
    // Store 1 / w and depth
    uniform_wide inv_w = wide_of(1) / w;
    uniform_wide depth = z / w;
    v.inv_w = float(inv_w);
    v.z = float(depth);
    v.placed = true;
}

// Clips triangle p to the visible region. Leaves a convex polygon on the grid, or nothing.
BN_FN void clip_triangle_to_frame(frame_ref f, BN_INOUT(clip_polygon) p)
{
    p.count = 3;
    for (int plane = 0; plane < kClipPlanes; ++plane)
        clip_by_plane(f, plane, p);
    for (int i = 0; i < p.count; ++i) {
        if (!p.corner[i].placed)
            snap_corner(f, p.corner[i]);
    }
}

// Returns a polygon's visible side: 1 front, -1 back, 0 for no area. The pieces of its fan around corner 0 may turn over on
// the grid. A piece that shows the other side would overlap its neighbours, so callers drop it.
BN_FN int seen_side(BN_IN(clip_polygon) p)
{
    // Sum the fan's signed areas
    uniform_wide area = wide_of(0);
    for (int i = 1; i + 1 < p.count; ++i) {
        uniform_wide x1 = wide_of(p.corner[i].x - p.corner[0].x);
        uniform_wide y1 = wide_of(p.corner[i].y - p.corner[0].y);
        uniform_wide x2 = wide_of(p.corner[i + 1].x - p.corner[0].x);
        uniform_wide y2 = wide_of(p.corner[i + 1].y - p.corner[0].y);
        area = area + (x1 * y2 - x2 * y1);
    }
    // Counter-clockwise with y up is front
    return area < wide_of(0) ? 1 : (area > wide_of(0) ? -1 : 0);
}

// Returns the corner that comes j-th. A front face swaps its second and third corner, so that its area becomes positive
// with y down.
BN_FN int turned_corner(bool front, int j)
{
    return front && j > 0 ? 3 - j : j;
}

BN_KERNELS_END

#endif
