// From a pixel position to the direction of the ray through it.
#ifndef BN_CAMERA_RAY_K_H
#define BN_CAMERA_RAY_K_H

#include "shading/kernels/vertex.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// (px, py): pixels from the image's top left corner. half_width, half_height: half the image, pixels. Returns a direction in world
// space, not unit; all rays of an orthographic view are parallel.
BN_FN real3 pixel_ray(real px, real py, real half_width, real half_height, view_params view)
{
    real x = (px - half_width) / half_width / view.inv_tan_x;
    real y = (half_height - py) / half_height / view.inv_tan_y;
    real3 through = view.forward + view.right * x + view.up * y;
    return select(view.orthographic, view.forward, through);
}

BN_KERNELS_END

#endif
