// Directional albedo of GGX under Schlick's Fresnel: F = F0 * scale + F90 * bias, from the baked table or an analytic fit.
// Karis 2013, "Real Shading in Unreal Engine 4", "Environment BRDF".
#ifndef BN_DFG_K_H
#define BN_DFG_K_H
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct dfg_value {
    real scale;
    real bias;
};

// Interpolates pairs (scale, bias) bilinearly. row0, row1: left pairs in two rows; fx, fy: place between columns and rows,
// [0,1].
BN_FN dfg_value dfg_between(pair_table table, integer row0, integer row1, real fx, real fy)
{
    real w11 = fx * fy;
    real w10 = fx - w11;
    real w01 = fy - w11;
    real w00 = lit(1.0) - fx - w01;
    real4 upper = pairs_at(table, row0);
    real4 lower = pairs_at(table, row1);
    dfg_value r;
    r.scale = w00 * upper.x + w10 * upper.z + (w01 * lower.x + w11 * lower.z);
    r.bias = w00 * upper.y + w10 * upper.w + (w01 * lower.y + w11 * lower.w);
    return r;
}

// Returns a bilinear fetch from the table: size x size pairs (scale, bias), row = perceptual roughness y / (size - 1),
// column = n.v x / (size - 1). Clamps inputs to [0,1]; NaN counts as 0.
BN_FN dfg_value dfg_lookup(pair_table table, int size, real n_dot_v, real roughness)
{
    real last = to_real(int_lit(size - 1));
    real x = min(max(n_dot_v, lit(0.0)), lit(1.0)) * last;
    real y = min(max(roughness, lit(0.0)), lit(1.0)) * last;
    integer ix = min(to_int(x), int_lit(size - 2));
    integer iy = min(to_int(y), int_lit(size - 2));
    real fx = x - to_real(ix);
    real fy = y - to_real(iy);
    integer row0 = iy * int_lit(size) + ix;
    return dfg_between(table, row0, row0 + int_lit(size), fx, fy);
}

// Returns the fit from Pesce and Iwanicki 2015, "Approximate models for physically based rendering": coarse, small and
// smooth. roughness: perceptual, [0,1]; n_dot_v: [0,1].
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
