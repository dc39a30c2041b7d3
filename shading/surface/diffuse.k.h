// The diffuse part of Ashikhmin and Shirley 2000, "An Anisotropic Phong BRDF Model", eq. 5, as factors on Lambert's BRDF.
// It takes the light that a lobe with reflectance f0 leaves, so that both together conserve energy, and it is reciprocal.
#ifndef BN_DIFFUSE_K_H
#define BN_DIFFUSE_K_H

#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

BN_FN real phong_diffuse_rise(real cosine)
{
    real m = lit(1.0) - lit(0.5) * cosine;
    real m2 = m * m;
    return lit(1.0) - m2 * m2 * m;
}

// Returns the factor for the eye at that cosine, times 1 - f0: the albedo of a surface without absorption.
BN_FN real phong_diffuse_seen(real f0, real n_dot_v)
{
    return (lit(1.0) - f0) * phong_diffuse_rise(n_dot_v);
}

// Returns the factor for light at that cosine; its cosine-weighted mean is 1.
BN_FN real phong_diffuse_lit(real n_dot_l)
{
    return lit(1.2173913043478261) * phong_diffuse_rise(n_dot_l); // 28 / 23
}

BN_KERNELS_END

#endif
