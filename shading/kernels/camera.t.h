// The frame's camera: its view, rays through its pixels, vertices on its sub-pixel grid.
#ifndef BN_CAMERA_T_H
#define BN_CAMERA_T_H

#include "shading/kernels/camera_ray.k.h"
#include "shading/kernels/vertex.k.h"
#include "shading/lang/frame.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Broadcasts a view to lanes.
BN_FN view_params view_params_of(BN_IN(ViewRecord) v)
{
    view_params r;
    r.eye = splat3(v.eye);
    r.right = splat3(v.right);
    r.up = splat3(v.up);
    r.forward = splat3(v.forward);
    r.inv_tan_x = splat(v.inv_tan_x);
    r.inv_tan_y = splat(v.inv_tan_y);
    r.znear = splat(v.znear);
    r.zfar = splat(v.zfar);
    r.inv_depth = splat(v.inv_depth);
    r.orthographic = int_lit(v.orthographic) != int_lit(0);
    return r;
}

// Returns where snapped positions are 0, in 1/256 pixel from the picture's top left corner.
BN_FN int center_in_picture_x(frame_ref f)
{
    return the_frame(f).center_x + the_frame(f).left * kSubpixel;
}
BN_FN int center_in_picture_y(frame_ref f)
{
    return the_frame(f).center_y + the_frame(f).top * kSubpixel;
}

// Returns a point's place for ray_to(). view: the frame's; (x, y): pixels from the picture's top left corner.
BN_FN real2 place_on_screen(frame_ref f, BN_IN(view_params) view, real x, real y)
{
    return vec2_of(screen_x(x, splat(the_frame(f).half_width), view.inv_tan_x),
                   screen_y(y, splat(the_frame(f).half_height), view.inv_tan_y));
}
// Returns the ray through a point of the picture, world space, not unit.
BN_FN real3 ray_through(frame_ref f, BN_IN(view_params) view, real x, real y)
{
    return ray_to(place_on_screen(f, view, x, y), view);
}

// Snaps a clip-space vertex to the frame's sub-pixel grid, see snap_vertex(). guard: 1/256 pixel.
BN_FN snapped_vertex snap_to_frame(frame_ref f, real4 clip, BN_IN(view_params) view, int guard)
{
    integer center_x = int_lit(center_in_picture_x(f));
    integer center_y = int_lit(center_in_picture_y(f));
    return snap_vertex(clip, view, splat(the_frame(f).half_width), splat(the_frame(f).half_height), to_real(center_x), to_real(center_y),
                       center_x, center_y, to_real(int_lit(guard)));
}

BN_KERNELS_END

#endif
