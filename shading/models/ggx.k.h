// Isotropic GGX: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 33, with
// height-correlated Smith masking-shadowing: Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based
// BRDFs", eq. 99. Conventions: microfacet.k.h.
#ifndef BN_GGX_K_H
#define BN_GGX_K_H

#include "shading/kernels/fresnel.k.h"
#include "shading/kernels/math.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Returns the normal distribution, 1/sr. n_dot_h in [0,1]; sin2_h = |n x h|^2 keeps digits near n_dot_h = 1; alpha in
// [1e-3,1].
BN_FN real ggx_d(real n_dot_h, real sin2_h, real alpha)
{
    real a = n_dot_h * alpha;
    real k = alpha / max(sin2_h + a * a, lit(1e-12));
    return k * k * lit(0.31830988618379067);
}

// Returns G2 / (4 n_dot_l n_dot_v). Cosines in (0,1].
BN_FN real ggx_visibility(real n_dot_l, real n_dot_v, real alpha)
{
    real a2 = alpha * alpha;
    real one = lit(1.0);
    real v = n_dot_l * sqrt(n_dot_v * n_dot_v * (one - a2) + a2);
    real l = n_dot_v * sqrt(n_dot_l * n_dot_l * (one - a2) + a2);
    return lit(0.5) / max(v + l, lit(1e-12));
}

struct ggx_params {
    real alpha;
};

BN_FN ggx_params ggx_params_of(real alpha)
{
    ggx_params p;
    p.alpha = usable_alpha(alpha);
    return p;
}

// Returns s = |(alpha x, alpha y, z)|. Smith's G1 is 2 / (1 + s / w.z).
BN_FN real ggx_stretch(ggx_params p, real3 w)
{
    return sqrt(p.alpha * p.alpha * (w.x * w.x + w.y * w.y) + w.z * w.z);
}

BN_FN real ggx_eval(ggx_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real d = ggx_d(h.z, h.x * h.x + h.y * h.y, p.alpha);
    real bottom = wi.z * ggx_stretch(p, wo) + wo.z * ggx_stretch(p, wi);
    real value = d * (lit(0.5) / max(bottom, lit(1e-16)));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns eval times the cosine of wi, over D.
BN_FN real ggx_masking(ggx_params p, real3 wo, real3 wi)
{
    real bottom = wi.z * ggx_stretch(p, wo) + wo.z * ggx_stretch(p, wi);
    return lit(0.5) * wi.z / max(bottom, lit(1e-16));
}

// Returns eval about any normal n, without axes. n, v, l: unit, in one space; n_dot_v in (0,1]. Light cosines below 1e-4
// count as 1e-4.
BN_FN real ggx_eval_about(ggx_params p, real3 n, real3 v, real n_dot_v, real3 l)
{
    real3 h = k_normalize3(l + v);
    real n_dot_h = min(max(k_dot3(n, h), lit(0.0)), lit(1.0));
    real3 c = k_cross(n, h);
    real d = ggx_d(n_dot_h, k_dot3(c, c), p.alpha);
    real g = ggx_visibility(max(k_dot3(n, l), lit(1e-4)), n_dot_v, p.alpha);
    return d * g;
}

// Returns the density of normals visible from wo: G1 D (wo.h) / wo.z, 1/sr.
BN_FN real ggx_half_pdf(ggx_params p, real3 wo, real3 h)
{
    real d = ggx_d(h.z, h.x * h.x + h.y * h.y, p.alpha);
    real top = lit(2.0) * d * max(k_dot3(wo, h), lit(0.0));
    real value = top / max(wo.z + ggx_stretch(p, wo), lit(1e-20));
    return select(both_above(wo, h), value, lit(0.0));
}

BN_FN real ggx_pdf(ggx_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real d = ggx_d(h.z, h.x * h.x + h.y * h.y, p.alpha);
    real value = lit(0.5) * d / max(wo.z + ggx_stretch(p, wo), lit(1e-20));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Samples visible normals. The weight, G2 / G1, is at most 1.
BN_FN bsdf_sample ggx_sample(ggx_params p, real3 wo, real2 xi)
{
    real3 up = vec3_of(wo.x, wo.y, max(wo.z, lit(0.0)));
    real3 stretched = k_normalize3(vec3_of(p.alpha * up.x, p.alpha * up.y, up.z));
    real3 seen = visible_hemisphere_normal(stretched, xi);
    real3 h = k_normalize3(vec3_of(p.alpha * seen.x, p.alpha * seen.y, seen.z));
    real3 wi = mirror_direction(wo, h);
    real so = ggx_stretch(p, wo);
    real bottom = wi.z * so + wo.z * ggx_stretch(p, wi);
    real weight = wi.z * (wo.z + so) / max(bottom, lit(1e-16));
    real d = ggx_d(h.z, h.x * h.x + h.y * h.y, p.alpha);
    real pdf = lit(0.5) * d / max(wo.z + so, lit(1e-20));
    return bsdf_sample_of(wi, weight, pdf, k_dot3(wo, h), both_above(wo, wi));
}

BN_KERNELS_END

#endif
