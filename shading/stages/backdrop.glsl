// What is seen where no triangle is.
#ifndef BN_BACKDROP_GLSL
#define BN_BACKDROP_GLSL

#include "shading/stages/stage.glsl"
#include "shading/kernels/camera_ray.k.h"

real3 shade_background(int px, int py)
{
    if (frame.background == 0)
        return vec3_all(lit(0.0));
    real x = to_real(px) + lit(0.5);
    real y = to_real(py) + lit(0.5);
    real3 ray = pixel_ray(x, y, frame.half_width, frame.half_height, frame_view());
    return cube_sample(whole_cube(0), ray, lit(0.0)) * frame.whole.scale;
}

#endif
