// Maps pixel positions to ray directions.
#ifndef BN_CAMERA_RAY_K_H
#define BN_CAMERA_RAY_K_H

#include "shading/kernels/vertex.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Returns where the ray through an image point meets the plane at distance 1, along the view's right and up. (px, py):
// pixels from the image's top left corner. half_width, half_height: half the image, pixels.
BN_FN real screen_x(real px, real half_width, real inv_tan_x)
{
    real x = (px - half_width) / half_width / inv_tan_x;
    return x;
}
BN_FN real screen_y(real py, real half_height, real inv_tan_y)
{
    real y = (half_height - py) / half_height / inv_tan_y;
    return y;
}

// Returns the ray direction in world space, not unit. place: screen_x(), screen_y(). An orthographic view has parallel
// rays.
BN_FN real3 ray_to(real2 place, view_params view)
{
    real3 through = view.forward + view.right * place.x + view.up * place.y;
    return select(view.orthographic, view.forward, through);
}

BN_KERNELS_END

#endif
