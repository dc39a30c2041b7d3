// Anisotropic GGX with separable Smith masking-shadowing, G2 = G1(wo) G1(wi). The untilted ellipsoid distribution
// (ellipsoid.k.h) equals this model. Distribution, density and samples come from ggx_aniso.k.h. Conventions:
// microfacet.k.h.
#ifndef BN_GGX_ANISO_SEPARABLE_K_H
#define BN_GGX_ANISO_SEPARABLE_K_H

#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"
#include "shading/models/ggx_aniso.k.h"

BN_KERNELS_BEGIN

// Returns G1 G1 / (4 wo.z wi.z).
BN_FN real ggx_aniso_separable_visibility(ggx_aniso_params p, real3 wo, real3 wi)
{
    real bottom = (wo.z + ggx_aniso_stretch(p, wo)) * (wi.z + ggx_aniso_stretch(p, wi));
    return lit(1.0) / max(bottom, lit(1e-16));
}

// Returns eval times the cosine of wi, over D.
BN_FN real ggx_aniso_separable_masking(ggx_aniso_params p, real3 wo, real3 wi)
{
    return ggx_aniso_separable_visibility(p, wo, wi) * wi.z;
}

BN_FN real ggx_aniso_separable_eval(ggx_aniso_params p, real3 wo, real3 wi)
{
    real value = ggx_aniso_d(p, half_vector(wo, wi)) * ggx_aniso_separable_visibility(p, wo, wi);
    return select(both_above(wo, wi), value, lit(0.0));
}

BN_FN real ggx_aniso_separable_pdf(ggx_aniso_params p, real3 wo, real3 wi)
{
    return ggx_aniso_pdf(p, wo, wi);
}

BN_FN real ggx_aniso_separable_half_pdf(ggx_aniso_params p, real3 wo, real3 h)
{
    return ggx_aniso_half_pdf(p, wo, h);
}

// Samples wi. The weight is G1(wi).
BN_FN bsdf_sample ggx_aniso_separable_sample(ggx_aniso_params p, real3 wo, real2 xi)
{
    real3 h = ggx_aniso_visible_normal(p, wo, xi);
    real3 wi = mirror_direction(wo, h);
    real weight = lit(2.0) * wi.z / max(wi.z + ggx_aniso_stretch(p, wi), lit(1e-20));
    real pdf = lit(0.5) * ggx_aniso_d(p, h) / max(wo.z + ggx_aniso_stretch(p, wo), lit(1e-20));
    return bsdf_sample_of(wi, weight, pdf, k_dot3(wo, h), both_above(wo, wi));
}

BN_KERNELS_END

#endif
