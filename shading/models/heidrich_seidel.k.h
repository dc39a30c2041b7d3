// Heidrich and Seidel 1998, "Efficient Rendering of Anisotropic Surfaces Using Computer Graphics Hardware": the surface as
// a bundle of threads along the tangent x. The model is no BRDF: it is not normalised, its diffuse part is not reciprocal,
// and it gives reflected over incident intensity. So, unlike other models (microfacet.k.h), heidrich_seidel_eval replaces
// BRDF times cosine, and callers apply no further cosine. Samples are uniform over the hemisphere, weight = eval / pdf. A
// density proportional to the cosine would have infinite variance at the horizon, where the diffuse part does not vanish.
#ifndef BN_HEIDRICH_SEIDEL_K_H
#define BN_HEIDRICH_SEIDEL_K_H

#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct heidrich_seidel_params {
    real kd, ks;   // diffuse and specular coefficients, [0, 1e6]
    real exponent; // Phong exponent, [0, 1e4]
};

BN_FN heidrich_seidel_params heidrich_seidel_params_of(real kd, real ks, real exponent)
{
    heidrich_seidel_params p;
    p.kd = min(max(kd, lit(0.0)), lit(1e6));
    p.ks = min(max(ks, lit(0.0)), lit(1e6));
    p.exponent = min(max(exponent, lit(0.0)), lit(1e4));
    return p;
}

// Returns the parameters of a brushed surface: shiny threads with reflectance 1 along x. To second order, the lobe is as
// wide as a GGX lobe with width alpha. The mirror direction turns twice as far as the normal, so cos^e has the curvature of
// a half vector with exponent 1 / alpha^2.
BN_FN heidrich_seidel_params heidrich_seidel_params_of_alpha(real alpha)
{
    real a = usable_alpha(alpha);
    real exponent = lit(0.5) / (a * a);
    return heidrich_seidel_params_of(lit(0.0), lit(1.0), exponent);
}

// Returns the sine of the angle between w and the thread: the diffuse term for light from w.
BN_FN real heidrich_seidel_diffuse(real3 w)
{
    return sqrt(max(lit(1.0) - w.x * w.x, lit(0.0)));
}

// Returns the cosine between wo and the nearest mirror direction on the thread, clamped at 0. The cosine is negative where
// both directions lean towards the same end of the thread; an even exponent would light those.
BN_FN real heidrich_seidel_mirror(real3 wo, real3 wi)
{
    real value = heidrich_seidel_diffuse(wi) * heidrich_seidel_diffuse(wo) - wi.x * wo.x;
    return max(value, lit(0.0));
}

// Surfaces reflect only light from above the horizon: a clamp that threads do not need.
BN_FN real heidrich_seidel_eval(heidrich_seidel_params p, real3 wo, real3 wi)
{
    real m = heidrich_seidel_mirror(wo, wi);
    real gloss = select(m > lit(0.0), k_pow(min(m, lit(1.0)), p.exponent), lit(0.0));
    real value = p.kd * heidrich_seidel_diffuse(wi) + p.ks * gloss;
    return select(both_above(wo, wi), value, lit(0.0));
}

BN_FN real heidrich_seidel_pdf(real3 wo, real3 wi)
{
    return select(both_above(wo, wi), lit(0.15915494309189534), lit(0.0));
}

BN_FN bsdf_sample heidrich_seidel_sample(heidrich_seidel_params p, real3 wo, real2 xi)
{
    real2 d = concentric_disk(xi);
    real z = concentric_rest(xi); // equal areas: z = 1 - r^2
    real s = sqrt(lit(1.0) + z);
    real3 wi = vec3_of(d.x * s, d.y * s, z);
    real weight = heidrich_seidel_eval(p, wo, wi) * lit(6.2831853071795865);
    real3 h = half_vector(wo, wi);
    return bsdf_sample_of(wi, weight, heidrich_seidel_pdf(wo, wi), k_dot3(wo, h), both_above(wo, wi));
}

BN_KERNELS_END

#endif
