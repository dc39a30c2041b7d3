// Lambert's diffuse reflection with albedo 1. Samples follow the cosine. Conventions: microfacet.k.h.
#ifndef BN_LAMBERT_K_H
#define BN_LAMBERT_K_H

#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

BN_FN real lambert_eval(real3 wo, real3 wi)
{
    return select(both_above(wo, wi), lit(0.31830988618379067), lit(0.0));
}

BN_FN real lambert_pdf(real3 wo, real3 wi)
{
    return select(both_above(wo, wi), wi.z * lit(0.31830988618379067), lit(0.0));
}

BN_FN bsdf_sample lambert_sample(real3 wo, real2 xi)
{
    real2 d = concentric_disk(xi);
    real3 wi = vec3_of(d.x, d.y, sqrt(concentric_rest(xi)));
    real3 h = half_vector(wo, wi);
    return bsdf_sample_of(wi, lit(1.0), lambert_pdf(wo, wi), k_dot3(wo, h), both_above(wo, wi));
}

BN_KERNELS_END

#endif
