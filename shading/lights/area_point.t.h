// Points of area lights.
#ifndef BN_AREA_POINT_T_H
#define BN_AREA_POINT_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Returns point k of a light, world space; for a disk, points 1 and 2 are its half axes.
BN_FN real3 area_point(frame_ref f, int light, int k)
{
    return vec3_of(splat(the_area_light(f, light).points[3 * k]), splat(the_area_light(f, light).points[3 * k + 1]),
                   splat(the_area_light(f, light).points[3 * k + 2]));
}

BN_KERNELS_END

#endif
