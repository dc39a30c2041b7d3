// Transforms from world space to the sub-pixel grid. Clip space is Vulkan's with y up; depth is reversed, with the far
// plane at infinity. A perspective view has clip z = znear, so depth = znear / w. An orthographic view has w = 1 and linear
// depth.
#ifndef BN_VERTEX_K_H
#define BN_VERTEX_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct view_params { // uniform; see raster/frame View
    real3 eye, right, up, forward;
    real inv_tan_x, inv_tan_y;   // 1 / tan of the half angles; orthographic: 1 / half extents, 1/m
    real znear, zfar, inv_depth; // m; inv_depth = 1 / (zfar - znear), orthographic only
    mask orthographic;
};

// Transforms world position p (metres) to clip space (x, y, w, z).
BN_FN real4 clip_position(real3 p, view_params view)
{
    real3 d = p - view.eye;
    real x = k_dot3(view.right, d) * view.inv_tan_x;
    real y = k_dot3(view.up, d) * view.inv_tan_y;
    real depth = k_dot3(view.forward, d);
    real w = select(view.orthographic, lit(1.0), depth);
    real z = select(view.orthographic, (view.zfar - depth) * view.inv_depth, view.znear);
    return vec4_of(x, y, w, z);
}

struct snapped_vertex {
    integer x, y;  // 1/256 pixel, right and down, relative to the centre pixel's top left corner
    real inv_w, z; // 1 / clip w; depth in [0,1], 1 near
    mask valid;    // in front of the near plane and inside the guard band
};

// Snaps a clip position c, in the order above. half_width, half_height: half the image, pixels. center_x, center_y: the
// centre pixel's corner, 1/256 pixel, as real and as integer. guard: bound on |x|, |y| of a valid vertex, 1/256 pixel.
BN_FN snapped_vertex snap_vertex(real4 c, view_params view, real half_width, real half_height, real center_x, real center_y,
                                 integer icenter_x, integer icenter_y, real guard)
{
    // Test the near plane
    mask perspective_front = both(not_(view.orthographic), c.z >= view.znear);
    mask orthographic_front = both(view.orthographic, c.w <= lit(1.0));
    mask in_front = either(perspective_front, orthographic_front);
    // Project to pixels, and test the guard band
    real inv_w = lit(1.0) / select(in_front, c.z, lit(1.0));
    real px = ((c.x * inv_w) * half_width + half_width) * lit(256.0);
    real py = ((-c.y * inv_w) * half_height + half_height) * lit(256.0);
    real from_center_x = abs(px - center_x);
    real from_center_y = abs(py - center_y);
    mask inside = both(from_center_x < guard, from_center_y < guard);
    // Round to the grid
    snapped_vertex v;
    v.valid = both(in_front, inside);
    px = select(v.valid, px, lit(0.0));
    py = select(v.valid, py, lit(0.0));
    v.x = round_to_int(px) - icenter_x;
    v.y = round_to_int(py) - icenter_y;
    v.inv_w = inv_w;
    v.z = c.w * inv_w;
    return v;
}

BN_KERNELS_END

#endif
