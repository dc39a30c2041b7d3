// Ward 1992, "Measuring and Modeling Anisotropic Reflection", specular part with reflectance 1 and the exact one of his two
// exponents: -tan^2 of the half vector's angle, in units of the widths. ward_cheap.k.h has his approximation, with its own
// density and samples. The model has neither masking nor Fresnel, and the BRDF grows without bound at the horizon: cosines
// below 1e-4 count as 1e-4. Conventions: microfacet.k.h.
#ifndef BN_WARD_K_H
#define BN_WARD_K_H

#include "shading/kernels/math_special.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct ward_params {
    real alpha_x, alpha_y; // sqrt(2) times the slope deviation along tangent and bitangent, at least 1e-3
};

BN_FN ward_params ward_params_of(real alpha_x, real alpha_y)
{
    ward_params p;
    p.alpha_x = usable_alpha(alpha_x);
    p.alpha_y = usable_alpha(alpha_y);
    return p;
}

// Returns the square root of a direction's cosine, as the model divides by it.
BN_FN real ward_root(real z)
{
    return sqrt(max(z, lit(1e-4)));
}

// Returns (x / alpha_x)^2 + (y / alpha_y)^2.
BN_FN real ward_ellipse(ward_params p, real3 h)
{
    real x = h.x / p.alpha_x;
    real y = h.y / p.alpha_y;
    return x * x + y * y;
}

BN_FN real ward_scale(ward_params p, real3 wo, real3 wi)
{
    real bottom = p.alpha_x * p.alpha_y * (ward_root(wo.z) * ward_root(wi.z));
    return lit(0.079577471545947668) / bottom;
}

BN_FN real ward_eval(ward_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real value = k_exp(-(ward_ellipse(p, h) / max(h.z * h.z, lit(1e-8)))) * ward_scale(p, wo, wi);
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns the density of half vectors, 1/sr: exp(-tan^2) / (pi alpha_x alpha_y h.z^3).
BN_FN real ward_half_density(ward_params p, real3 h)
{
    real z = max(h.z, lit(1e-4));
    real e = k_exp(-(ward_ellipse(p, h) / (z * z)));
    return e * lit(0.31830988618379067) / (p.alpha_x * p.alpha_y * z * z * z);
}

BN_FN real ward_half_pdf(ward_params p, real3 wo, real3 h)
{
    return select(both_above(wo, h), ward_half_density(p, h), lit(0.0));
}

BN_FN real ward_pdf(ward_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real value = ward_half_density(p, h) / (lit(4.0) * max(k_dot3(wo, h), lit(1e-10)));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Samples a half vector, unit; slopes along the axes are independent and Gaussian. Walter 2005, "Notes on the Ward BRDF".
BN_FN real3 ward_half_vector(ward_params p, real2 xi)
{
    k_sin_cos_pair turn = k_sin_cos(lit(6.2831853071795865) * xi.x);
    real r = sqrt(max(-k_log1p(-xi.y), lit(0.0)));
    return k_normalize3(vec3_of(p.alpha_x * r * turn.cosine, p.alpha_y * r * turn.sine, lit(1.0)));
}

// Samples wi. The weight, (wo.h) h.z^3 sqrt(wi.z / wo.z), exceeds 1 towards grazing wo and is at most 1 / sqrt(wo.z).
BN_FN bsdf_sample ward_sample(ward_params p, real3 wo, real2 xi)
{
    real3 h = ward_half_vector(p, xi);
    real o_dot_h = k_dot3(wo, h);
    real3 wi = mirror_direction(wo, h);
    real weight = o_dot_h * h.z * h.z * h.z * wi.z / (ward_root(wo.z) * ward_root(wi.z));
    real pdf = ward_half_density(p, h) / (lit(4.0) * max(o_dot_h, lit(1e-10)));
    return bsdf_sample_of(wi, weight, pdf, o_dot_h, both(both_above(wo, wi), o_dot_h > lit(0.0)));
}

BN_KERNELS_END

#endif
