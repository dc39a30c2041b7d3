// Isotropic GGX with height-correlated Smith masking-shadowing. Walter et al. 2007, eq. 33; Heitz 2014, eq. 99.
#ifndef BN_GGX_K_H
#define BN_GGX_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Distribution of normals, 1/sr. n_dot_h in [0,1]; sin2_h = |n x h|^2 keeps digits near n_dot_h = 1; alpha in [1e-3,1].
BN_FN real ggx_d(real n_dot_h, real sin2_h, real alpha)
{
    real a = n_dot_h * alpha;
    real k = alpha / max(sin2_h + a * a, lit(1e-12));
    return k * k * lit(0.31830988618379067);
}

// G2 / (4 n_dot_l n_dot_v). Cosines in (0,1].
BN_FN real ggx_visibility(real n_dot_l, real n_dot_v, real alpha)
{
    real a2 = alpha * alpha;
    real one = lit(1.0);
    real v = n_dot_l * sqrt(n_dot_v * n_dot_v * (one - a2) + a2);
    real l = n_dot_v * sqrt(n_dot_l * n_dot_l * (one - a2) + a2);
    return lit(0.5) / max(v + l, lit(1e-12));
}

// Schlick 1994. f0, f90: reflectance at normal incidence and at grazing; v_dot_h in [0,1].
BN_FN real3 fresnel_schlick(real3 f0, real3 f90, real v_dot_h)
{
    real m = lit(1.0) - v_dot_h;
    real m2 = m * m;
    real m5 = m2 * m2 * m;
    return f0 + (f90 - f0) * m5;
}

BN_KERNELS_END

#endif
