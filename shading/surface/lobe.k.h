// An anisotropic lobe on a surface: its slope deviations and the directions of its axes.
#ifndef BN_LOBE_K_H
#define BN_LOBE_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct aniso_lobe {
    real3 u_axis, v_axis;  // unit, orthogonal to each other and to the shading normal; world space
    real sigma_u, sigma_v; // standard deviations of slope along them, sigma_u >= sigma_v >= 0
};

// Returns the lobe's perceptual roughness: the square root of its mean alpha, where alpha = sqrt(2) sigma.
BN_FN real lobe_roughness(aniso_lobe lobe)
{
    real mean = (lobe.sigma_u + lobe.sigma_v) * lit(0.70710678118654752);
    return min(sqrt(max(mean, lit(0.0))), lit(1.0));
}

// Returns the degree of anisotropy, [0,1].
BN_FN real lobe_eta(aniso_lobe lobe)
{
    real sum = lobe.sigma_u + lobe.sigma_v;
    real difference = lobe.sigma_u - lobe.sigma_v;
    return select(sum > lit(1e-20), difference / max(sum, lit(1e-20)), lit(0.0));
}

// Returns the anisotropic share of a blend with round lobes, [0,1]: 0 for equal widths, 1 from a relative difference of an
// eighth on. Round lobes use other methods with other results, so the blend avoids a step.
BN_FN real anisotropy_blend_of(real sigma_u, real sigma_v)
{
    return k_saturate(lit(8.0) * (sigma_u - sigma_v) / max(sigma_u, lit(1e-20)));
}

// Transform between world space and the ellipse frame (u, v, n).
BN_FN real3 to_lobe(aniso_lobe lobe, real3 n, real3 w)
{
    return vec3_of(k_dot3(lobe.u_axis, w), k_dot3(lobe.v_axis, w), k_dot3(n, w));
}
BN_FN real3 from_lobe(aniso_lobe lobe, real3 n, real3 w)
{
    return lobe.u_axis * w.x + lobe.v_axis * w.y + n * w.z;
}

BN_KERNELS_END

#endif
