// Parts that all reflection models share. Directions are unit vectors that point away from the surface, in the local frame
// (x tangent, y bitangent, z normal). wo is given, wi is evaluated or sampled. A model <model> has
//    <model>_params_of(...)     parameters clamped to a range in which nothing divides by zero
//    <model>_eval(p, wo, wi)    the BRDF without the cosine of wi, 1/sr
//    <model>_sample(p, wo, xi)  a wi with its weight and density, xi in [0,1)^2; may reject a sample as invalid
//    <model>_pdf(p, wo, wi)     density of the valid samples, 1/sr; integrates to 1 minus the rejected share
// All are 0 where wo or wi is not above the horizon. The caller applies Fresnel reflectance as a factor: it is coloured,
// and depends only on wo.h, which a sample carries along.
#ifndef BN_MICROFACET_K_H
#define BN_MICROFACET_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct bsdf_sample {
    real3 wi;     // unit and finite, even where invalid
    real weight;  // eval cos / pdf; 0 where invalid
    real pdf;     // 1/sr; 0 where invalid
    real o_dot_h; // cosine between wo and the microfacet normal, [0,1]: the argument of Fresnel's equations
    mask valid;
};

BN_FN bsdf_sample bsdf_sample_of(real3 wi, real weight, real pdf, real o_dot_h, mask valid)
{
    bsdf_sample s;
    s.wi = wi;
    s.weight = select(valid, weight, lit(0.0));
    s.pdf = select(valid, pdf, lit(0.0));
    s.o_dot_h = k_saturate(o_dot_h);
    s.valid = valid;
    return s;
}

BN_FN mask both_above(real3 wo, real3 wi)
{
    return both(wo.z > lit(0.0), wi.z > lit(0.0));
}

// Returns the unit half vector. Opposite directions have none and give the normal.
BN_FN real3 half_vector(real3 wo, real3 wi)
{
    real3 sum = wo + wi;
    real length2 = k_dot3(sum, sum);
    return select(length2 > lit(1e-20), k_normalize3(sum), vec3_of(lit(0.0), lit(0.0), lit(1.0)));
}

BN_FN real3 mirror_direction(real3 w, real3 h)
{
    return h * (lit(2.0) * k_dot3(w, h)) - w;
}

// Clamps a GGX width to a usable range; NaN becomes the smallest width.
BN_FN real usable_alpha(real alpha)
{
    return min(max(alpha, lit(1e-3)), lit(1e3));
}

// Returns a vector along a visible normal of GGX with width 1: the normal at a random point of the hemisphere as seen from
// w (unit, w.z >= 0). The vector is not unit, z >= 0. Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical
// Caps", with the cap's sine written without 1 - z^2.
BN_FN real3 visible_hemisphere_normal(real3 w, real2 xi)
{
    k_sin_cos_pair turn = k_sin_cos(lit(6.2831853071795865) * xi.x);
    real top = lit(1.0) + w.z;
    real rest = (w.x * w.x + w.y * w.y) / top; // 1 - w.z
    real height = (lit(1.0) - xi.y) * top;
    real s = sqrt(max(xi.y * top * (height + rest), lit(0.0)));
    return vec3_of(s * turn.cosine + w.x, s * turn.sine + w.y, height);
}

// Maps the square [0,1)^2 to the unit disk. Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square".
BN_FN real2 concentric_disk(real2 xi)
{
    real a = lit(2.0) * xi.x - lit(1.0);
    real b = lit(2.0) * xi.y - lit(1.0);
    mask wide = abs(a) > abs(b);
    real r = select(wide, a, b);
    real other = select(wide, b, a);
    real ratio = other / select(r == lit(0.0), lit(1.0), r);
    k_sin_cos_pair turn = k_sin_cos(lit(0.78539816339744831) * ratio);
    return vec2_of(r * select(wide, turn.cosine, turn.sine), r * select(wide, turn.sine, turn.cosine));
}

// Returns 1 - r^2 of concentric_disk(xi), with all digits at the rim, where 1 - |point|^2 would have none.
BN_FN real concentric_rest(real2 xi)
{
    real r = max(abs(lit(2.0) * xi.x - lit(1.0)), abs(lit(2.0) * xi.y - lit(1.0)));
    return (lit(1.0) - r) * (lit(1.0) + r);
}

BN_KERNELS_END

#endif
