// Perspective-correct vertex weights: Heckbert and Moreton 1991, "Interpolation for Polygon Texture Mapping and Shading",
// in homogeneous form.
#ifndef BN_INTERPOLATE_K_H
#define BN_INTERPOLATE_K_H

#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct bary_weights {
    real3 b;     // weights of the three vertices, sum 1 up to rounding
    mask inside; // the point lies in the triangle or on its edge
    real w;      // clip w at the point, for clipped pieces; else 0
};

// Returns twice the areas opposite each vertex. (x, y)_i: vertex i minus the point, 1/256 pixel, exact integers below 2^24.
BN_FN real3 edge_areas(real3 x, real3 y)
{
    real e0 = x.y * y.z - x.z * y.y;
    real e1 = x.z * y.x - x.x * y.z;
    real e2 = x.x * y.y - x.y * y.x;
    return vec3_of(e0, e1, e2);
}

// Returns ax * by - bx * ay with relative error 2^-23, where floats lose 2^-24 of the products. Inputs are integers below
// 2^24, split into halves with 12 bits.
BN_FN real exact_area(integer ax, integer ay, integer bx, integer by)
{
    integer low_bits = int_lit(4095);
    integer axh = shr(ax, 12);
    integer axl = ax & low_bits;
    integer ayh = shr(ay, 12);
    integer ayl = ay & low_bits;
    integer bxh = shr(bx, 12);
    integer bxl = bx & low_bits;
    integer byh = shr(by, 12);
    integer byl = by & low_bits;
    integer low = axl * byl - bxl * ayl;
    integer middle = axh * byl + axl * byh - bxh * ayl - bxl * ayh + shr(low, 12);
    integer high = axh * byh - bxh * ayh + shr(middle, 12);
    integer rest = shl(middle & low_bits, 12) + (low & low_bits);
    return to_real(high) * lit(16777216.0) + to_real(rest);
}

// Returns weights from edge_areas() e of a triangle with positive area. inv_w: 1 / clip w.
BN_FN bary_weights weights_of_areas(real3 e, real3 inv_w)
{
    real p0 = e.x * inv_w.x;
    real p1 = e.y * inv_w.y;
    real p2 = e.z * inv_w.z;
    real sum = p0 + p1 + p2;
    mask degenerate = both(sum<lit(1e-30), sum> lit(-1e-30));
    real inv = lit(1.0) / select(degenerate, lit(1.0), sum);
    bary_weights r;
    r.b = select(degenerate, vec3_all(lit(1.0 / 3.0)), vec3_of(p0 * inv, p1 * inv, p2 * inv));
    r.inside = both(both(e.x >= lit(0.0), e.y >= lit(0.0)), e.z >= lit(0.0));
    r.w = lit(0.0);
    return r;
}

// Returns weights at a point. x, y: as in edge_areas().
BN_FN bary_weights perspective_weights(real3 x, real3 y, real3 inv_w)
{
    return weights_of_areas(edge_areas(x, y), inv_w);
}

// A triangle for interpolation: a whole triangle or a piece of a clipped one.
struct triangle_setup {
    integer x[3], y[3]; // corners, 1/256 pixel
    real3 inv_w;        // 1 / clip w of the corners
    integer vertex[3];  // the whole triangle's
    integer info;       // material << 2 | kFrontFacing | kClipped
    real3 unclip[3];    // a piece's corners in barycentrics of the whole triangle
    mask piece;         // this is a piece
    bool clipped;       // some lane has a piece
};

// Returns a piece's weights in terms of the whole triangle; m_j are the barycentrics of the piece's corner j.
BN_FN real3 unclip_weights(real3 b, real3 m0, real3 m1, real3 m2)
{
    return m0 * b.x + m1 * b.y + m2 * b.z;
}

// Returns weights of the whole triangle's vertices at a point, 1/256 pixel. A piece may reach far beyond the picture, and
// its corners' w may differ by millions, so a piece needs areas that are right to their own last place.
BN_FN bary_weights weights_at(BN_IN(triangle_setup) t, integer x, integer y)
{
    // Find the areas opposite the corners
    integer x0 = t.x[0] - x;
    integer x1 = t.x[1] - x;
    integer x2 = t.x[2] - x;
    integer y0 = t.y[0] - y;
    integer y1 = t.y[1] - y;
    integer y2 = t.y[2] - y;
    real3 e = edge_areas(vec3_of(to_real(x0), to_real(x1), to_real(x2)), vec3_of(to_real(y0), to_real(y1), to_real(y2)));
    if (t.clipped) {
        e = select(t.piece, vec3_of(exact_area(x1, y1, x2, y2), exact_area(x2, y2, x0, y0), exact_area(x0, y0, x1, y1)), e);
    }
    // Find the weights, and map a piece's weights to the whole triangle
    bary_weights w = weights_of_areas(e, t.inv_w);
    if (t.clipped) {
        w.w = w.b.x / t.inv_w.x + w.b.y / t.inv_w.y + w.b.z / t.inv_w.z;
        w.b = unclip_weights(w.b, t.unclip[0], t.unclip[1], t.unclip[2]);
    }
    return w;
}

BN_KERNELS_END

#endif
