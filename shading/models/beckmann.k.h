// Anisotropic Beckmann (Beckmann and Spizzichino 1963), height-correlated Smith masking-shadowing with the rational Lambda
// from Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", section 5.2. Conventions:
// microfacet.k.h.
#ifndef BN_BECKMANN_K_H
#define BN_BECKMANN_K_H

#include "shading/kernels/math_special.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct beckmann_params {
    real alpha_x, alpha_y; // sqrt(2) times the slope deviation along tangent and bitangent, at least 1e-3
};

BN_FN beckmann_params beckmann_params_of(real alpha_x, real alpha_y)
{
    beckmann_params p;
    p.alpha_x = usable_alpha(alpha_x);
    p.alpha_y = usable_alpha(alpha_y);
    return p;
}

// Returns the normal distribution, 1/sr; h unit. At the horizon the exponential wins.
BN_FN real beckmann_d(beckmann_params p, real3 h)
{
    real z2 = max(h.z * h.z, lit(1e-8));
    real x = h.x / p.alpha_x;
    real y = h.y / p.alpha_y;
    real e = k_exp(-((x * x + y * y) / z2));
    return e * lit(0.31830988618379067) / (p.alpha_x * p.alpha_y * z2 * z2);
}

// Returns |w.z| Lambda(w), which stays finite at the horizon. With s = |(alpha_x x, alpha_y y)| and c = |w.z| / s, Lambda
// is (1 - 1.259 c + 0.396 c^2) / (3.535 c + 2.181 c^2) for c < 1.6, and 0 above.
BN_FN real beckmann_z_lambda(beckmann_params p, real3 w)
{
    real x = p.alpha_x * w.x;
    real y = p.alpha_y * w.y;
    real s = sqrt(x * x + y * y);
    real z = abs(w.z);
    real limit = lit(1.6) * s;
    real c = min(z / max(s, lit(1e-12)), lit(1.6));
    real value = s * (lit(1.0) - lit(1.259) * c + lit(0.396) * c * c) / (lit(3.535) + lit(2.181) * c);
    return select(z < limit, value, lit(0.0));
}

// Returns G2 / (wo.z wi.z), G2 = 1 / (1 + Lambda(wo) + Lambda(wi)).
BN_FN real beckmann_visibility(beckmann_params p, real3 wo, real3 wi)
{
    real bottom = wo.z * wi.z + wi.z * beckmann_z_lambda(p, wo) + wo.z * beckmann_z_lambda(p, wi);
    return lit(1.0) / max(bottom, lit(1e-16));
}

BN_FN real beckmann_eval(beckmann_params p, real3 wo, real3 wi)
{
    real value = lit(0.25) * beckmann_d(p, half_vector(wo, wi)) * beckmann_visibility(p, wo, wi);
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns the density of sampled normals: D h.z over all normals, visible from wo or not.
BN_FN real beckmann_half_pdf(beckmann_params p, real3 wo, real3 h)
{
    real value = beckmann_d(p, h) * h.z;
    return select(both_above(wo, h), value, lit(0.0));
}

BN_FN real beckmann_pdf(beckmann_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real value = beckmann_d(p, h) * h.z / (lit(4.0) * max(k_dot3(wo, h), lit(1e-10)));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Samples a surface normal, unit. Slopes along the axes are independent and Gaussian, so a regular grid of xi is a regular
// grid of their quantiles.
BN_FN real3 beckmann_normal(beckmann_params p, real2 xi)
{
    real x = p.alpha_x * k_erfinv(lit(2.0) * xi.x - lit(1.0));
    real y = p.alpha_y * k_erfinv(lit(2.0) * xi.y - lit(1.0));
    return k_normalize3(vec3_of(-x, -y, lit(1.0)));
}

// Samples wi. The weight, G2 (wo.h) / (wo.z h.z), is unbounded: it grows towards grazing wo.
BN_FN bsdf_sample beckmann_sample(beckmann_params p, real3 wo, real2 xi)
{
    real3 h = beckmann_normal(p, xi);
    real o_dot_h = k_dot3(wo, h);
    real3 wi = mirror_direction(wo, h);
    real weight = beckmann_visibility(p, wo, wi) * wi.z * o_dot_h / h.z;
    real pdf = beckmann_d(p, h) * h.z / (lit(4.0) * max(o_dot_h, lit(1e-10)));
    return bsdf_sample_of(wi, weight, pdf, o_dot_h, both(both_above(wo, wi), o_dot_h > lit(0.0)));
}

BN_KERNELS_END

#endif
