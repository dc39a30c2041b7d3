// Turns a surface's frame by a normal map, in the way that the frame asks for.
#ifndef BN_FRAME_BY_MAP_T_H
#define BN_FRAME_BY_MAP_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Returns the surface's frame under a normal map, turned by the method that the material's record names.
BN_FN surface_frame frame_by_map(material_ref m, surface_frame axes, real3 map, real handedness)
{
    if (the_material(m).frame_map == kFrameQuaternion)
        return turned_frame(axes, map);
    if (the_material(m).frame_map == kFrameNormalOnly)
        return bent_frame(axes, map);
    return mapped_frame(axes, map, handedness);
}

BN_KERNELS_END

#endif
