// Anisotropic GGX with height-correlated Smith masking-shadowing: Burley 2012, "Physically-Based Shading at Disney", eq.
// 13; Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", eq. 99. Separable form:
// ggx_aniso_separable.k.h. Conventions: microfacet.k.h.
#ifndef BN_GGX_ANISO_K_H
#define BN_GGX_ANISO_K_H

#include "shading/kernels/math.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct ggx_aniso_params {
    real alpha_x, alpha_y; // widths along tangent and bitangent, at least 1e-3
};

BN_FN ggx_aniso_params ggx_aniso_params_of(real alpha_x, real alpha_y)
{
    ggx_aniso_params p;
    p.alpha_x = usable_alpha(alpha_x);
    p.alpha_y = usable_alpha(alpha_y);
    return p;
}

// Returns the normal distribution, 1/sr; h unit.
BN_FN real ggx_aniso_d(ggx_aniso_params p, real3 h)
{
    real x = h.x / p.alpha_x;
    real y = h.y / p.alpha_y;
    real q = max(x * x + y * y + h.z * h.z, lit(1e-12));
    return lit(0.31830988618379067) / (p.alpha_x * p.alpha_y * q * q);
}

// Returns s = |(alpha_x x, alpha_y y, z)|. Smith's G1 is 2 w.z / (w.z + s), his Lambda (s / w.z - 1) / 2.
BN_FN real ggx_aniso_stretch(ggx_aniso_params p, real3 w)
{
    real x = p.alpha_x * w.x;
    real y = p.alpha_y * w.y;
    return sqrt(x * x + y * y + w.z * w.z);
}

// Returns G2 / (4 wo.z wi.z), height-correlated.
BN_FN real ggx_aniso_visibility(ggx_aniso_params p, real3 wo, real3 wi)
{
    real bottom = wi.z * ggx_aniso_stretch(p, wo) + wo.z * ggx_aniso_stretch(p, wi);
    return lit(0.5) / max(bottom, lit(1e-16));
}

// Returns eval times the cosine of wi, over D.
BN_FN real ggx_aniso_masking(ggx_aniso_params p, real3 wo, real3 wi)
{
    return ggx_aniso_visibility(p, wo, wi) * wi.z;
}

BN_FN real ggx_aniso_eval(ggx_aniso_params p, real3 wo, real3 wi)
{
    real value = ggx_aniso_d(p, half_vector(wo, wi)) * ggx_aniso_visibility(p, wo, wi);
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns the density of normals visible from wo: G1 D (wo.h) / wo.z, 1/sr.
BN_FN real ggx_aniso_half_pdf(ggx_aniso_params p, real3 wo, real3 h)
{
    real top = lit(2.0) * ggx_aniso_d(p, h) * max(k_dot3(wo, h), lit(0.0));
    real value = top / max(wo.z + ggx_aniso_stretch(p, wo), lit(1e-20));
    return select(both_above(wo, h), value, lit(0.0));
}

BN_FN real ggx_aniso_pdf(ggx_aniso_params p, real3 wo, real3 wi)
{
    real d = ggx_aniso_d(p, half_vector(wo, wi));
    real value = lit(0.5) * d / max(wo.z + ggx_aniso_stretch(p, wo), lit(1e-20));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Samples a normal visible from wo, unit: stretches wo to a surface with width 1, samples there, and maps back. Heitz 2018,
// "Sampling the GGX Distribution of Visible Normals", section 3.
BN_FN real3 ggx_aniso_visible_normal(ggx_aniso_params p, real3 wo, real2 xi)
{
    real3 stretched = k_normalize3(vec3_of(p.alpha_x * wo.x, p.alpha_y * wo.y, max(wo.z, lit(0.0))));
    real3 seen = visible_hemisphere_normal(stretched, xi);
    return k_normalize3(vec3_of(p.alpha_x * seen.x, p.alpha_y * seen.y, seen.z));
}

// Samples wi. The weight, G2 / G1(wo), is at most 1.
BN_FN bsdf_sample ggx_aniso_sample(ggx_aniso_params p, real3 wo, real2 xi)
{
    real3 h = ggx_aniso_visible_normal(p, wo, xi);
    real3 wi = mirror_direction(wo, h);
    real so = ggx_aniso_stretch(p, wo);
    real bottom = wi.z * so + wo.z * ggx_aniso_stretch(p, wi);
    real weight = wi.z * (wo.z + so) / max(bottom, lit(1e-16));
    real pdf = lit(0.5) * ggx_aniso_d(p, h) / max(wo.z + so, lit(1e-20));
    return bsdf_sample_of(wi, weight, pdf, k_dot3(wo, h), both_above(wo, wi));
}

BN_KERNELS_END

#endif
