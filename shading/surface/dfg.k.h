// Directional albedo of GGX under Schlick's Fresnel: F = F0 * scale + F90 * bias from the baked
// table or from an analytic fit. Karis 2013, "Real Shading in Unreal Engine 4", "Environment BRDF".
#ifndef BN_DFG_K_H
#define BN_DFG_K_H
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct dfg_value {
    real scale;
    real bias;
};

// Bilinear fetch from the table as texels: size x size RGBA halves, row = perceptual roughness y / (size -
// 1), column = n.v x / (size - 1); scale = R + B and bias = G + A, where B and A hold what rounding took from
// R and G. Inputs are clamped to [0,1]; NaN counts as 0.
BN_FN dfg_value dfg_lookup(texel_buffer table, int size, real n_dot_v, real roughness)
{
    real last = to_real(int_lit(size - 1));
    real x = min(max(n_dot_v, lit(0.0)), lit(1.0)) * last;
    real y = min(max(roughness, lit(0.0)), lit(1.0)) * last;
    integer ix = min(to_int(x), int_lit(size - 2));
    integer iy = min(to_int(y), int_lit(size - 2));
    real fx = x - to_real(ix);
    real fy = y - to_real(iy);
    integer row0 = iy * int_lit(size) + ix;
    real w11 = fx * fy;
    real w10 = fx - w11;
    real w01 = fy - w11;
    real w00 = lit(1.0) - fx - w01;
    texel_acc acc = texel_zero();
    real4 t = texel_value(texel_add(acc, table, row0, row0 + int_lit(size), w00, w10, w01, w11));
    dfg_value r;
    r.scale = t.x + t.z;
    r.bias = t.y + t.w;
    return r;
}

// Pesce and Iwanicki 2015, "Approximate models for physically based rendering": coarse (0.07 rms, up to 0.17
// off), small and smooth. roughness: perceptual, [0,1]; n_dot_v: [0,1].
BN_FN dfg_value dfg_fit(real n_dot_v, real roughness)
{
    real a = roughness * roughness;
    dfg_value r;
    r.bias = k_exp2(-(lit(7.0) * n_dot_v + lit(4.0) * a));
    real knee = min(roughness, lit(0.739) + lit(0.323) * n_dot_v) - lit(0.434);
    r.scale = lit(1.0) - r.bias - a * max(r.bias, knee);
    return r;
}

BN_KERNELS_END
#endif
