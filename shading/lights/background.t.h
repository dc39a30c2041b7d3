// The environment with its extracted lights, as seen where no triangle is.
#ifndef BN_BACKGROUND_T_H
#define BN_BACKGROUND_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/camera.t.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Converts a texel to radiance. texel: level 0 of full_env() in a direction.
BN_FN real3 radiance_of_texel(frame_ref f, real3 texel)
{
    return texel * splat(the_frame(f).whole.scale);
}

// Returns the environment's radiance. direction: any length.
BN_FN real3 environment_radiance(frame_ref f, real3 direction)
{
    return radiance_of_texel(f, cube_sample_level(full_env(f), direction, 0));
}

// Returns the ray through a pixel centre, not unit. view: the frame's. x, y: pixel.
BN_FN real3 background_ray(frame_ref f, BN_IN(view_params) view, integer x, integer y)
{
    return ray_to(place_of_center(f, view, x, y), view);
}

BN_FN real3 background_color(frame_ref f, BN_IN(view_params) view, integer x, integer y)
{
    if (the_frame(f).background == 0)
        return vec3_all(lit(0.0));
    return environment_radiance(f, background_ray(f, view, x, y));
}

BN_KERNELS_END

#endif
