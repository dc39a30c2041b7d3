// Depth over a triangle: a plane in double precision, so that every viewer of the plane sees the same depth. From the
// corner of a pixel block on, floats follow the plane. z: depth, 1 near. Names with 10, 20 are differences between vertices
// 1, 2 and vertex 0.
#ifndef BN_DEPTH_PLANE_K_H
#define BN_DEPTH_PLANE_K_H

#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Computes the change of depth per 1/256 pixel to the right and down. x, y: 1/256 pixel; the area must not be 0.
BN_FN void depth_slopes(any_wide x10, any_wide y10, any_wide x20, any_wide y20, any_wide z10, any_wide z20, BN_INOUT(any_wide) right,
                        BN_INOUT(any_wide) down)
{
    any_wide inv_area = wide_like(x10, 1.0) / (x10 * y20 - x20 * y10);
    right = (z10 * y20 - z20 * y10) * inv_area;
    down = (x10 * z20 - x20 * z10) * inv_area;
}

// Converts a slope to change per pixel.
BN_FN any_wide depth_slope_by_pixel(any_wide slope)
{
    any_wide by_pixel = slope * wide_like(slope, 256.0);
    return by_pixel;
}

// Returns depth at a point. from_x, from_y: offset from vertex 0, 1/256 pixel.
BN_FN any_wide depth_at(any_wide z0, any_wide right, any_wide down, any_wide from_x, any_wide from_y)
{
    any_wide z = z0 + right * from_x + down * from_y;
    return z;
}

// Returns the change of depth over an offset. dz_x, dz_y: change per pixel; x, y: pixels.
BN_FN real depth_change(real dz_x, real dz_y, real x, real y)
{
    real change = dz_x * x + dz_y * y;
    return change;
}

// Returns depth at a sample. pixel: depth at the pixel's corner; step: depth_change() from there. least, greatest: range
// over the triangle's vertices, to which rounding errors are clamped.
BN_FN real depth_at_sample(real pixel, real step, real least, real greatest)
{
    real z = pixel + step;
    return min(max(z, least), greatest);
}

BN_KERNELS_END

#endif
