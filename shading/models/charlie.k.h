// Cloth: Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF", the lobe of KHR_materials_sheen. Fibres stand up
// from the surface, so that most normals lie near its horizon. Conventions: microfacet.k.h. Cosines in denominators count as
// at least 1e-4. Below roughness .25 and at views more grazing than 3 degrees the lobe
// reflects more light than it receives.
#ifndef BN_CHARLIE_K_H
#define BN_CHARLIE_K_H

#include "shading/kernels/math_special.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct charlie_params {
    real inverse_alpha;         // exponent of the sine, [1, 100]
    real a, b, c, d, e, middle; // of charlie_lambda_log(); middle: twice its value at 1/2
};

// Returns the logarithm of the masking function for a cosine in [0, 1/2]; equation 3.
BN_FN real charlie_lambda_log(charlie_params p, real cosine)
{
    return p.a / (lit(1.0) + p.b * k_pow(cosine, p.c)) + p.d * cosine + p.e;
}

BN_FN charlie_params charlie_params_of(real alpha)
{
    charlie_params p;
    real width = min(max(alpha, lit(0.01)), lit(1.0));
    p.inverse_alpha = lit(1.0) / width;
    // Mix the paper's two fits
    real rest = lit(1.0) - width;
    real narrow = rest * rest;
    p.a = k_mix(lit(21.5473), lit(25.3245), narrow);
    p.b = k_mix(lit(3.82987), lit(3.32435), narrow);
    p.c = k_mix(lit(0.19823), lit(0.16801), narrow);
    p.d = k_mix(lit(-1.97760), lit(-1.27393), narrow);
    p.e = k_mix(lit(-4.32054), lit(-4.85967), narrow);
    p.middle = lit(0.0);
    p.middle = lit(2.0) * charlie_lambda_log(p, lit(0.5));
    return p;
}

// Returns Smith's Lambda. cosine: [0,1].
BN_FN real charlie_lambda(charlie_params p, real cosine)
{
    real near_horizon = charlie_lambda_log(p, min(cosine, lit(1.0) - cosine));
    return k_exp(select(cosine < lit(0.5), near_horizon, p.middle - near_horizon));
}

// Returns the density of normals, 1/sr. sin2_h: squared sine between normal and half vector; cos2_h: squared cosine. Near the
// horizon ln(1 - cos2_h) keeps its digits, elsewhere ln(sin2_h) does.
BN_FN real charlie_density(charlie_params p, real sin2_h, real cos2_h)
{
    real flat_part = k_log1p(-min(cos2_h, lit(0.5)));
    real steep = k_log2(max(sin2_h, lit(1e-30))) * lit(0.69314718055994531);
    real lg = select(cos2_h < lit(0.5), flat_part, steep);
    return (lit(2.0) + p.inverse_alpha) * k_exp(lit(0.5) * p.inverse_alpha * lg) * lit(0.15915494309189534);
}

// Returns the BRDF from its angles.
BN_FN real charlie_value(charlie_params p, real sin2_h, real cos2_h, real n_dot_v, real n_dot_l)
{
    real v = min(max(n_dot_v, lit(1e-4)), lit(1.0));
    real l = min(max(n_dot_l, lit(1e-4)), lit(1.0));
    real shadowed = lit(1.0) + charlie_lambda(p, v) + charlie_lambda(p, l);
    return charlie_density(p, sin2_h, cos2_h) / (lit(4.0) * v * l * shadowed);
}

BN_FN real charlie_eval(charlie_params p, real3 wo, real3 wi)
{
    real3 h = half_vector(wo, wi);
    real value = charlie_value(p, h.x * h.x + h.y * h.y, h.z * h.z, wo.z, wi.z);
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns eval about any normal n, without axes. n, v, l: unit, in one space; n_dot_v in (0,1].
BN_FN real charlie_eval_about(charlie_params p, real3 n, real3 v, real n_dot_v, real3 l)
{
    real3 h = k_normalize3(l + v);
    real n_dot_h = min(max(k_dot3(n, h), lit(0.0)), lit(1.0));
    real3 c = k_cross(n, h);
    return charlie_value(p, k_dot3(c, c), n_dot_h * n_dot_h, n_dot_v, k_dot3(n, l));
}

// Returns the density of samples, the same for every direction: the lobe covers the hemisphere.
BN_FN real charlie_pdf(charlie_params, real3 wo, real3 wi)
{
    return select(both_above(wo, wi), lit(0.15915494309189534), lit(0.0));
}

// Returns the density of the samples' half vectors, 1/sr.
BN_FN real charlie_half_pdf(charlie_params p, real3 wo, real3 h)
{
    real density = charlie_pdf(p, wo, mirror_direction(wo, h)) * (lit(4.0) * max(k_dot3(wo, h), lit(0.0)));
    return select(both_above(wo, h), density, lit(0.0));
}

BN_FN bsdf_sample charlie_sample(charlie_params p, real3 wo, real2 xi)
{
    real2 d = concentric_disk(xi);
    real height = concentric_rest(xi);
    real stretch = sqrt(lit(1.0) + height);
    real3 wi = vec3_of(d.x * stretch, d.y * stretch, height);
    real3 h = half_vector(wo, wi);
    real weight = charlie_eval(p, wo, wi) * height * lit(6.2831853071795865);
    return bsdf_sample_of(wi, weight, charlie_pdf(p, wo, wi), k_dot3(wo, h), both_above(wo, wi));
}

// Returns a cubic polynomial.
BN_FN real charlie_cubic(real x, real c0, real c1, real c2, real c3)
{
    return ((c3 * x + c2) * x + c1) * x + c0;
}

// Returns the directional albedo, at most 1. n_dot_v: [0,1]; roughness: perceptual, [.1,1]. A fit to integrals of this file's
// lobe: off by at most .01, by at most .05 at views more grazing than 3 degrees.
BN_FN real charlie_albedo(real n_dot_v, real roughness)
{
    real r = min(max(roughness, lit(0.1)), lit(1.0));
    real s = sqrt(n_dot_v);
    real lg = charlie_cubic(r, lit(-81.7007594), lit(244.372573), lit(-282.919413), lit(112.651376));
    lg = lg * s + charlie_cubic(r, lit(120.273395), lit(-354.045733), lit(419.577129), lit(-170.716099));
    lg = lg * s + charlie_cubic(r, lit(-61.3876904), lit(171.979871), lit(-208.328629), lit(86.6717617));
    lg = lg * s + charlie_cubic(r, lit(7.14394433), lit(-18.7046807), lit(24.2527621), lit(-10.8202731));
    lg = lg * s + charlie_cubic(r, lit(0.77095844), lit(-5.59778288), lit(8.58404136), lit(-3.96182813));
    real narrow = charlie_cubic(n_dot_v, lit(0.0), lit(0.0129677492), lit(-0.443603452), lit(0.495998296));
    return min(k_exp(min(lg + narrow / (r * r), lit(1.0))), lit(1.0));
}

// The mean direction of the reflected light: along * (v - n n.v) + up * n. Its length falls as the lobe widens.
struct charlie_mean {
    real along, up;
};

// Returns the mean direction by a fit to integrals of the lobe, off by at most .05 where the albedo is above .05. Parameters:
// charlie_albedo().
BN_FN charlie_mean charlie_mean_of(real n_dot_v, real roughness)
{
    real r = min(max(roughness, lit(0.1)), lit(1.0));
    charlie_mean m;
    m.along = charlie_cubic(n_dot_v, lit(0.400347361), lit(3.05976746), lit(-6.88901959), lit(6.63510912)) +
              r * charlie_cubic(n_dot_v, lit(-0.587552651), lit(-6.78557823), lit(16.9843211), lit(-15.1489494)) +
              r * r * charlie_cubic(n_dot_v, lit(0.256279171), lit(4.08286423), lit(-10.6705161), lit(9.08420095));
    m.up = charlie_cubic(n_dot_v, lit(0.0468772528), lit(0.283294524), lit(-1.12439871), lit(1.04076299)) +
           r * charlie_cubic(n_dot_v, lit(1.03326272), lit(0.703709677), lit(0.0884086773), lit(-1.29568827)) +
           r * r * charlie_cubic(n_dot_v, lit(-0.617133984), lit(-0.49038771), lit(0.284154409), lit(0.616524242));
    return m;
}

BN_KERNELS_END

#endif
