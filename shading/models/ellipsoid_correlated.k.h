// The ellipsoid distribution of normals (ellipsoid.k.h) with height-correlated Smith masking-shadowing, G2 = 1 / (1 /
// G1(wo) + 1 / G1(wi) - 1): Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", eq. 99.
// The ellipsoid's G1 (Walter et al. 2014, Eq. 6) is limited to 1, which keeps Lambda from falling below 0. The untilted
// model equals ggx_aniso.k.h, samples included: the same random numbers give the same samples. So a lobe with a tiny tilt
// looks like an untilted one. Conventions: microfacet.k.h.
#ifndef BN_ELLIPSOID_CORRELATED_K_H
#define BN_ELLIPSOID_CORRELATED_K_H

#include "shading/kernels/math.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"
#include "shading/models/ellipsoid.k.h"

BN_KERNELS_BEGIN

// Returns u.z / G1(u), for u above the horizon; at least 1 / k. v: ellipsoid_seen_from(p, u).
BN_FN real ellipsoid_z_over_g1(ellipsoid_params p, ellipsoid_view v, real3 u)
{
    real seen = v.sum / (lit(2.0) * p.an_length2);
    return max(seen, u.z);
}

// Returns wo.z wi.z / G2. o, i: ellipsoid_z_over_g1() of wo and wi.
BN_FN real ellipsoid_z2_over_g2(real3 wo, real o, real3 wi, real i)
{
    real r = wi.z * o + wo.z * i - wo.z * wi.z;
    return r;
}

// Returns G2 / (4 wo.z wi.z).
BN_FN real ellipsoid_correlated_visibility(ellipsoid_params p, real3 wo, real3 wi)
{
    real o = ellipsoid_z_over_g1(p, ellipsoid_seen_from(p, wo), wo);
    real i = ellipsoid_z_over_g1(p, ellipsoid_seen_from(p, wi), wi);
    return lit(0.25) / max(ellipsoid_z2_over_g2(wo, o, wi, i), lit(1e-16));
}

BN_FN real ellipsoid_correlated_eval(ellipsoid_params p, real3 wo, real3 wi)
{
    real value = ellipsoid_d(p, half_vector(wo, wi)) * ellipsoid_correlated_visibility(p, wo, wi);
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns eval times the cosine of wi, over the density that D has about its own normal.
BN_FN real ellipsoid_correlated_masking(ellipsoid_params p, real3 wo, real3 wi)
{
    real value = ellipsoid_correlated_visibility(p, wo, wi) * wi.z;
    return value / sqrt(p.an_length2);
}

BN_FN real ellipsoid_correlated_half_pdf(ellipsoid_params p, real3 wo, real3 h)
{
    return ellipsoid_half_pdf(p, wo, h);
}

BN_FN real ellipsoid_correlated_pdf(ellipsoid_params p, real3 wo, real3 wi)
{
    return ellipsoid_pdf(p, wo, wi);
}

// Samples a normal visible from wo, unit, as visible_hemisphere_normal() does, on the sphere that A makes of the ellipsoid,
// about A n. Mirrored directions fill a cap there evenly. 1 + and 1 - the cosine between A wo and A n are the view's sum
// and difference, which keep their digits. The frame about A n follows Duff et al. 2017, "Building an Orthonormal Basis,
// Revisited". v: ellipsoid_seen_from(p, wo).
BN_FN real3 ellipsoid_visible_normal_by_cap(ellipsoid_params p, ellipsoid_view v, real2 xi)
{
    // Build a frame about A n
    real3 n = p.an / sqrt(p.an_length2);
    real3 w = k_normalize3(v.au);
    real turn = select(n.z < lit(0.0), lit(-1.0), lit(1.0));
    real a = lit(-1.0) / (turn + n.z);
    real b = n.x * n.y * a;
    real3 t = vec3_of(lit(1.0) + turn * n.x * n.x * a, turn * b, -(turn * n.x));
    real3 s = vec3_of(b, turn + n.y * n.y * a, -n.y);
    // Sample the spherical cap of mirrored directions
    k_sin_cos_pair round = k_sin_cos(lit(6.2831853071795865) * xi.x);
    real over_lengths = lit(1.0) / max(v.lengths, lit(1e-20));
    real top = v.sum * over_lengths;
    real rest = v.hidden * over_lengths;
    real height = (lit(1.0) - xi.y) * top;
    real sine = sqrt(max(xi.y * top * (height + rest), lit(0.0)));
    real x = sine * round.cosine + k_dot3(w, t);
    real y = sine * round.sine + k_dot3(w, s);
    // Form the half vector
    real3 point = t * x + s * y + n * height;
    point = select(k_dot3(point, point) > lit(1e-18), k_normalize3(point), n); // nothing is visible from straight behind
    // Map back to the ellipsoid
    real3 m = p.r0 * (p.alpha_x * point.x) + p.r1 * (p.alpha_y * point.y) + p.r2 * point.z;
    return k_normalize3(m);
}

// Returns wi.z / (k wo.z wi.z / G2) = G2 / (k wo.z), at most 1.
BN_FN real ellipsoid_correlated_weight(ellipsoid_params p, ellipsoid_view v, real3 wo, real3 wi)
{
    real o = ellipsoid_z_over_g1(p, v, wo);
    real i = ellipsoid_z_over_g1(p, ellipsoid_seen_from(p, wi), wi);
    real bottom = v.k * ellipsoid_z2_over_g2(wo, o, wi, i);
    return wi.z / max(bottom, lit(1e-16));
}

BN_FN bsdf_sample ellipsoid_correlated_sample(ellipsoid_params p, real3 wo, real2 xi)
{
    ellipsoid_view v = ellipsoid_seen_from(p, wo);
    real3 m = ellipsoid_visible_normal_by_cap(p, v, xi);
    real3 wi = mirror_direction(wo, m);
    real o_dot_m = k_dot3(wo, m);
    real pdf = lit(0.25) * v.k * ellipsoid_d(p, m);
    mask valid = both(both_above(wo, wi), both(o_dot_m > lit(0.0), m.z > lit(0.0)));
    return bsdf_sample_of(wi, ellipsoid_correlated_weight(p, v, wo, wi), pdf, o_dot_m, valid);
}

// Returns directional albedo in the mirror limit: the weight of its only sample.
BN_FN real ellipsoid_correlated_mirror_albedo(ellipsoid_params p, real3 wo)
{
    real3 wi = mirror_direction(wo, p.r2);
    real weight = ellipsoid_correlated_weight(p, ellipsoid_seen_from(p, wo), wo, wi);
    mask seen = both(both_above(wo, wi), k_dot3(wo, p.r2) > lit(0.0));
    return select(seen, weight, lit(0.0));
}

BN_KERNELS_END

#endif
