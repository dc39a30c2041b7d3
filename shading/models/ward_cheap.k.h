// Ward 1992, "Measuring and Modeling Anisotropic Reflection", with the cheaper of his two exponents; specular part with
// reflectance 1. The exponent is -2 q / (1 + h.z) instead of -q / h.z^2 (ward.k.h), q = (h.x / alpha_x)^2 + (h.y /
// alpha_y)^2. The lobe is up to a fifth higher, so it has its own density and samples: mixing both models biases an
// estimate.
//
// For h at angle theta from the normal and azimuth phi, q = E(phi) sin^2(theta), and the exponent is -2 E (1 - cos(theta)).
// So 1 - h.z has an exponential distribution along every azimuth, and exp(-2 q / (1 + h.z)) / (pi alpha_x alpha_y) is a
// density of half vectors that needs no cosine. Its part below the horizon, exp(-2 E), is rejected: 4e-6 at width 0.4, 0.14
// at 1. The model has neither masking nor Fresnel, and grows without bound at the horizon, as in ward.k.h. Conventions:
// microfacet.k.h.
#ifndef BN_WARD_CHEAP_K_H
#define BN_WARD_CHEAP_K_H

#include "shading/kernels/math_special.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"
#include "shading/models/ward.k.h"

BN_KERNELS_BEGIN

BN_FN real ward_cheap_exponential(ward_params p, real3 h)
{
    real top = lit(-2.0) * ward_ellipse(p, h);
    return k_exp(top / (lit(1.0) + max(h.z, lit(0.0))));
}

BN_FN real ward_cheap_eval(ward_params p, real3 wo, real3 wi)
{
    real value = ward_cheap_exponential(p, half_vector(wo, wi)) * ward_scale(p, wo, wi);
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns the density of half vectors, 1/sr; h.z >= 0.
BN_FN real ward_cheap_half_density(ward_params p, real3 h)
{
    return ward_cheap_exponential(p, h) * lit(0.31830988618379067) / (p.alpha_x * p.alpha_y);
}

BN_FN real ward_cheap_half_pdf(ward_params p, real3 wo, real3 h)
{
    return select(both_above(wo, h), ward_cheap_half_density(p, h), lit(0.0));
}

BN_FN real ward_cheap_pdf(ward_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real value = ward_cheap_half_density(p, h) / (lit(4.0) * max(k_dot3(wo, h), lit(1e-10)));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Samples a half vector, unit: 1 - h.z = -ln(1 - xi.y) / (2 E), where 1 / E = (alpha_x cos)^2 + (alpha_y sin)^2 at the
// angle 2 pi xi.x. That angle relates to the azimuth as a circle's angle to an ellipse's. Vectors below the horizon move up
// to it, where nothing is reflected upwards.
BN_FN real3 ward_cheap_half_vector(ward_params p, real2 xi)
{
    k_sin_cos_pair turn = k_sin_cos(lit(6.2831853071795865) * xi.x);
    real x = p.alpha_x * turn.cosine;
    real y = p.alpha_y * turn.sine;
    real width2 = x * x + y * y;
    real fall = min(lit(0.5) * max(-k_log1p(-xi.y), lit(0.0)), lit(1.0) / width2);
    real down = fall * width2; // 1 - h.z
    real reach = sqrt(fall * (lit(2.0) - down));
    return k_normalize3(vec3_of(x * reach, y * reach, max(lit(1.0) - down, lit(0.0))));
}

// Samples wi. The weight, (wo.h) sqrt(wi.z / wo.z), exceeds 1 towards grazing wo and is at most 1 / sqrt(wo.z).
BN_FN bsdf_sample ward_cheap_sample(ward_params p, real3 wo, real2 xi)
{
    real3 h = ward_cheap_half_vector(p, xi);
    real o_dot_h = k_dot3(wo, h);
    real3 wi = mirror_direction(wo, h);
    real weight = o_dot_h * wi.z / (ward_root(wo.z) * ward_root(wi.z));
    real pdf = ward_cheap_half_density(p, h) / (lit(4.0) * max(o_dot_h, lit(1e-10)));
    return bsdf_sample_of(wi, weight, pdf, o_dot_h, both(both_above(wo, wi), o_dot_h > lit(0.0)));
}

BN_KERNELS_END

#endif
