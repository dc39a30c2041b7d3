// Perspective-correct weights: Heckbert and Moreton 1991, "Interpolation for Polygon Texture Mapping and Shading", in homogeneous form.
#ifndef BN_INTERPOLATE_K_H
#define BN_INTERPOLATE_K_H

#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct bary_weights {
    real3 b;     // weights of the three vertices, sum 1 up to rounding
    mask inside; // the point lies in the triangle or on its edge
};

// (x, y)_i: vertex i minus the point, 1/256 pixel, exact integers below 2^24; orientation: positive area. inv_w: 1 / clip w.
BN_FN bary_weights perspective_weights(real3 x, real3 y, real3 inv_w)
{
    real e0 = x.y * y.z - x.z * y.y; // twice the area opposite of each vertex
    real e1 = x.z * y.x - x.x * y.z;
    real e2 = x.x * y.y - x.y * y.x;
    real p0 = e0 * inv_w.x;
    real p1 = e1 * inv_w.y;
    real p2 = e2 * inv_w.z;
    real sum = p0 + p1 + p2;
    mask degenerate = both(sum<lit(1e-30), sum> lit(-1e-30));
    real inv = lit(1.0) / select(degenerate, lit(1.0), sum);
    bary_weights r;
    r.b = select(degenerate, vec3_all(lit(1.0 / 3.0)), vec3_of(p0 * inv, p1 * inv, p2 * inv));
    r.inside = both(both(e0 >= lit(0.0), e1 >= lit(0.0)), e2 >= lit(0.0));
    return r;
}

// A triangle, or the piece of one that clipping left, as interpolation wants it.
struct triangle_setup {
    integer x[3], y[3]; // corners, 1/256 pixel
    real3 inv_w;        // 1 / clip w of the corners
    integer vertex[3];  // of the whole triangle
    integer info;       // material << 2 | kFrontFacing | kClipped
    real3 unclip[3];    // corners of a piece in barycentrics of the whole triangle
    bool clipped;       // it is a piece; of lanes: some are
};

// Weights of a piece that clipping cut off, in terms of the whole triangle: corner j of the piece is m_j in its barycentrics.
BN_FN real3 unclip_weights(real3 b, real3 m0, real3 m1, real3 m2)
{
    return m0 * b.x + m1 * b.y + m2 * b.z;
}

// Weights of the whole triangle's vertices at a point, 1/256 pixel.
BN_FN bary_weights weights_at(BN_IN(triangle_setup) t, integer x, integer y)
{
    bary_weights w = perspective_weights(vec3_of(to_real(t.x[0] - x), to_real(t.x[1] - x), to_real(t.x[2] - x)),
                                         vec3_of(to_real(t.y[0] - y), to_real(t.y[1] - y), to_real(t.y[2] - y)), t.inv_w);
    if (t.clipped)
        w.b = unclip_weights(w.b, t.unclip[0], t.unclip[1], t.unclip[2]);
    return w;
}

BN_KERNELS_END

#endif
