// Ashikhmin and Shirley 2000, "An Anisotropic Phong BRDF Model": the specular part without its Fresnel factor. Conventions:
// microfacet.k.h. Cosines in denominators count as at least 1e-4.
#ifndef BN_ASHIKHMIN_SHIRLEY_K_H
#define BN_ASHIKHMIN_SHIRLEY_K_H

#include "shading/kernels/math_special.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct ashikhmin_shirley_params {
    real nu, nv; // exponents along tangent and bitangent, [0, 1e6]; about 1 / alpha^2
};

BN_FN ashikhmin_shirley_params ashikhmin_shirley_params_of(real nu, real nv)
{
    ashikhmin_shirley_params p;
    p.nu = min(max(nu, lit(0.0)), lit(1e6));
    p.nv = min(max(nv, lit(0.0)), lit(1e6));
    return p;
}

BN_FN ashikhmin_shirley_params ashikhmin_shirley_params_of_alpha(real alpha_x, real alpha_y)
{
    real x = usable_alpha(alpha_x);
    real y = usable_alpha(alpha_y);
    real nu = lit(1.0) / (x * x);
    real nv = lit(1.0) / (y * y);
    return ashikhmin_shirley_params_of(nu, nv);
}

// Returns the density of half vectors, 1/sr; h unit. The density has no further cosine, so it is no distribution of
// microfacet normals. h.z^e uses the logarithm. Near the normal ln(1 - r^2) / 2 keeps its digits for exponents in the
// thousands; away from it, where 1 - r^2 has few digits, ln(h.z) does.
BN_FN real ashikhmin_shirley_half_density(ashikhmin_shirley_params p, real3 h)
{
    real r2 = h.x * h.x + h.y * h.y;
    real e = (p.nu * h.x * h.x + p.nv * h.y * h.y) / max(r2, lit(1e-30));
    real close = lit(0.5) * k_log1p(-min(r2, lit(0.5)));
    real distant = k_log2(max(h.z, lit(1e-20))) * lit(0.69314718055994531);
    real lg = select(r2 < lit(0.5), close, distant);
    real scale = sqrt((p.nu + lit(1.0)) * (p.nv + lit(1.0))) * lit(0.15915494309189534);
    return scale * k_exp(e * lg);
}

BN_FN real ashikhmin_shirley_half_pdf(ashikhmin_shirley_params p, real3 wo, real3 h)
{
    return select(both_above(wo, h), ashikhmin_shirley_half_density(p, h), lit(0.0));
}

BN_FN real ashikhmin_shirley_pdf(ashikhmin_shirley_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real value = ashikhmin_shirley_half_density(p, h) / (lit(4.0) * max(k_dot3(wo, h), lit(1e-4)));
    return select(both_above(wo, wi), value, lit(0.0));
}

BN_FN real ashikhmin_shirley_eval(ashikhmin_shirley_params p, real3 wo, real3 wi)
{
    real value = ashikhmin_shirley_pdf(p, wo, wi) / max(max(wo.z, wi.z), lit(1e-4));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Samples a half vector, unit, for all four quadrants at once. The azimuth has tangent sqrt((nu + 1) / (nv + 1)) tan(2 pi
// xi.x). Then cos = (1 - xi.y)^(1 / (e + 1)), through logarithms.
BN_FN real3 ashikhmin_shirley_half_vector(ashikhmin_shirley_params p, real2 xi)
{
    k_sin_cos_pair turn = k_sin_cos(lit(6.2831853071795865) * xi.x);
    real2 d = k_normalize2(vec2_of(sqrt(p.nv + lit(1.0)) * turn.cosine, sqrt(p.nu + lit(1.0)) * turn.sine));
    real e = p.nu * d.x * d.x + p.nv * d.y * d.y;
    real lg = k_log1p(-xi.y) / (e + lit(1.0));
    real q = sqrt(max(-k_expm1(lit(2.0) * lg), lit(0.0)));
    return vec3_of(d.x * q, d.y * q, k_exp(lg));
}

// Samples wi. The weight, wi.z / max(wo.z, wi.z), is at most 1.
BN_FN bsdf_sample ashikhmin_shirley_sample(ashikhmin_shirley_params p, real3 wo, real2 xi)
{
    real3 h = ashikhmin_shirley_half_vector(p, xi);
    real o_dot_h = k_dot3(wo, h);
    real3 wi = mirror_direction(wo, h);
    real weight = wi.z / max(max(wo.z, wi.z), lit(1e-4));
    real pdf = ashikhmin_shirley_half_density(p, h) / (lit(4.0) * max(o_dot_h, lit(1e-4)));
    return bsdf_sample_of(wi, weight, pdf, o_dot_h, both(both_above(wo, wi), o_dot_h > lit(0.0)));
}

BN_KERNELS_END

#endif
