// Texture coordinates at a visible point: the texture's coordinate set, transformed by KHR_texture_transform.
#ifndef BN_TEXTURE_PLACE_K_H
#define BN_TEXTURE_PLACE_K_H

#include "shading/kernels/visible_point.k.h"
#include "shading/lang/lang.h"
#include "shading/lang/records.h"

BN_KERNELS_BEGIN

struct texture_place {
    real2 uv, dx, dy; // coordinates before wrapping, and their change per pixel
};

BN_FN texture_place texture_place_of(BN_IN(TextureBinding) b, BN_IN(visible_point) p)
{
    real2 uv = p.uv0;
    real2 dx = p.uv0_dx;
    real2 dy = p.uv0_dy;
    if (b.uv_set != 0) {
        uv = p.uv1;
        dx = p.uv1_dx;
        dy = p.uv1_dy;
    }
    real m0 = splat(b.transform[0]);
    real m1 = splat(b.transform[1]);
    real m2 = splat(b.transform[2]);
    real m3 = splat(b.transform[3]);
    texture_place r;
    r.uv = vec2_of(m0 * uv.x + m2 * uv.y + splat(b.transform[4]), m1 * uv.x + m3 * uv.y + splat(b.transform[5]));
    r.dx = vec2_of(m0 * dx.x + m2 * dx.y, m1 * dx.x + m3 * dx.y);
    r.dy = vec2_of(m0 * dy.x + m2 * dy.y, m1 * dy.x + m3 * dy.y);
    return r;
}

BN_KERNELS_END

#endif
