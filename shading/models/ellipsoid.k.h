// The ellipsoid distribution of normals: GGX on an ellipsoid that may be rotated and tilted, so the most frequent normal
// need not be the surface's. Walter, Dong, Marschner and Greenberg 2014 (revised 2016), "The Ellipsoid Normal Distribution
// Function". Equation numbers are theirs; two equations are used in corrected form: Eq. 25 is (Ma)x(Mb) = |M| M^-T (axb),
// and the point on the lune is A^-1 p_c. The paper's G1 has no horizon test; here eval, pdf and sample require wo and wi
// above the horizon. A = S R, S = diag(alpha_x, alpha_y, 1), R a rotation. Conventions of eval, sample and pdf:
// microfacet.k.h.
#ifndef BN_ELLIPSOID_K_H
#define BN_ELLIPSOID_K_H

#include "shading/kernels/math.k.h"
#include "shading/kernels/microfacet.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

struct ellipsoid_params {
    real alpha_x, alpha_y; // widths along the rows r0 and r1, at least 1e-3
    real3 r0;              // rows of R, orthonormal, from the surface's frame to the ellipsoid's
    real3 r1;
    real3 r2; // the most frequent normal; r2.z > 0 where the tilt is below 90 degrees
    real3 an; // A n
    real an_length2;
};

// Makes parameters for any rotation, by its rows.
BN_FN ellipsoid_params ellipsoid_params_of_rows(real alpha_x, real alpha_y, real3 r0, real3 r1, real3 r2)
{
    ellipsoid_params p;
    p.alpha_x = usable_alpha(alpha_x);
    p.alpha_y = usable_alpha(alpha_y);
    p.r0 = r0;
    p.r1 = r1;
    p.r2 = r2;
    p.an = vec3_of(p.alpha_x * r0.z, p.alpha_y * r1.z, r2.z);
    p.an_length2 = max(k_dot3(p.an, p.an), lit(1e-12));
    return p;
}

// Makes parameters for R = Rx(theta_x) Ry(theta_y) Rz(theta_z), rad, |theta| <= 2 pi (Eq. 3). theta_z > 0 turns the
// highlight clockwise. theta_x > 0 tilts the most frequent normal to +y, theta_y > 0 to -x, both in the ellipsoid's frame
// before theta_z.
BN_FN ellipsoid_params ellipsoid_params_of(real alpha_x, real alpha_y, real theta_x, real theta_y, real theta_z)
{
    k_sin_cos_pair x = k_sin_cos(theta_x);
    k_sin_cos_pair y = k_sin_cos(theta_y);
    k_sin_cos_pair z = k_sin_cos(theta_z);
    real3 yz0 = vec3_of(y.cosine * z.cosine, -(y.cosine * z.sine), y.sine);
    real3 yz1 = vec3_of(z.sine, z.cosine, lit(0.0));
    real3 yz2 = vec3_of(-(y.sine * z.cosine), y.sine * z.sine, y.cosine);
    real3 r1 = yz1 * x.cosine - yz2 * x.sine;
    real3 r2 = yz1 * x.sine + yz2 * x.cosine;
    return ellipsoid_params_of_rows(alpha_x, alpha_y, yz0, r1, r2);
}

// Returns A u.
BN_FN real3 ellipsoid_map(ellipsoid_params p, real3 u)
{
    return vec3_of(p.alpha_x * k_dot3(p.r0, u), p.alpha_y * k_dot3(p.r1, u), k_dot3(p.r2, u));
}

// Returns |A| A^-T u, the cofactor matrix times u, without divisions.
BN_FN real3 ellipsoid_cofactor(ellipsoid_params p, real3 u)
{
    return vec3_of(p.alpha_y * k_dot3(p.r0, u), p.alpha_x * k_dot3(p.r1, u), p.alpha_x * p.alpha_y * k_dot3(p.r2, u));
}

// Returns the normal distribution, 1/sr (Eq. 1); m unit.
BN_FN real ellipsoid_d(ellipsoid_params p, real3 m)
{
    real x = k_dot3(p.r0, m) / p.alpha_x;
    real y = k_dot3(p.r1, m) / p.alpha_y;
    real z = k_dot3(p.r2, m);
    real q = max(x * x + y * y + z * z, lit(1e-12)); // |A^-T m|^2
    real value = lit(0.31830988618379067) / (p.alpha_x * p.alpha_y * sqrt(p.an_length2) * q * q);
    return select(m.z >= lit(0.0), value, lit(0.0));
}

struct ellipsoid_view {
    real3 au;     // A u
    real lengths; // |A u| |A n|
    real sum;     // |A u| |A n| + A u . A n
    real hidden;  // |A u| |A n| - A u . A n
    real k;       // 2 |A n|^2 / sum: the ellipsoid's projected area over the projected area of the half visible from u
};

// Computes the view from u, unit. Of sum and difference, the one that cancels comes from the squared cross product, |A u x
// A n| = |cofactor (u x n)|, divided by the other (Eq. 25 and 43).
BN_FN ellipsoid_view ellipsoid_seen_from(ellipsoid_params p, real3 u)
{
    ellipsoid_view v;
    v.au = ellipsoid_map(p, u);
    real c = k_dot3(v.au, p.an);
    real au2 = k_dot3(v.au, v.au);
    v.lengths = sqrt(au2) * sqrt(p.an_length2);
    real3 area = ellipsoid_cofactor(p, vec3_of(u.y, -u.x, lit(0.0)));
    real wide = v.lengths + abs(c);
    real thin = k_dot3(area, area) / max(wide, lit(1e-20));
    v.sum = max(select(c >= lit(0.0), wide, thin), lit(1e-16));
    v.hidden = select(c >= lit(0.0), thin, wide);
    v.k = lit(2.0) * p.an_length2 / v.sum;
    return v;
}

// Returns Smith's G1 for u above the horizon (Eq. 6): min(1, k u.z).
BN_FN real ellipsoid_g1(ellipsoid_params p, real3 u)
{
    ellipsoid_view v = ellipsoid_seen_from(p, u);
    return min(v.k * max(u.z, lit(0.0)), lit(1.0));
}

// Returns G1(u) / u.z, finite at the horizon.
BN_FN real ellipsoid_g1_over_z(ellipsoid_params p, real3 u)
{
    ellipsoid_view v = ellipsoid_seen_from(p, u);
    return min(v.k, lit(1.0) / max(u.z, lit(1e-16)));
}

// Returns the BRDF without the cosine (Eq. 4 and 5).
BN_FN real ellipsoid_eval(ellipsoid_params p, real3 wo, real3 wi)
{
    real d = ellipsoid_d(p, half_vector(wo, wi));
    real value = lit(0.25) * d * ellipsoid_g1_over_z(p, wo) * ellipsoid_g1_over_z(p, wi);
    return select(both_above(wo, wi), value, lit(0.0));
}

// Returns eval times the cosine of wi, over the density that D has about its own normal.
BN_FN real ellipsoid_masking(ellipsoid_params p, real3 wo, real3 wi)
{
    real value = lit(0.25) * ellipsoid_g1_over_z(p, wo) * ellipsoid_g1_over_z(p, wi) * wi.z;
    return value / sqrt(p.an_length2);
}

// Returns the density of normals visible from wo, 1/sr (Eq. 33).
BN_FN real ellipsoid_half_pdf(ellipsoid_params p, real3 wo, real3 h)
{
    ellipsoid_view v = ellipsoid_seen_from(p, wo);
    real value = v.k * ellipsoid_d(p, h) * max(k_dot3(wo, h), lit(0.0));
    return select(both_above(wo, h), value, lit(0.0));
}

// Returns the density of samples, 1/sr (Eq. 48).
BN_FN real ellipsoid_pdf(ellipsoid_params p, real3 wo, real3 wi)
{
    ellipsoid_view v = ellipsoid_seen_from(p, wo);
    real value = lit(0.25) * v.k * ellipsoid_d(p, half_vector(wo, wi));
    return select(both_above(wo, wi), value, lit(0.0));
}

// Samples a normal visible from wo, unit (section 4.1, a to d). v: ellipsoid_seen_from(p, wo).
BN_FN real3 ellipsoid_visible_normal(ellipsoid_params p, ellipsoid_view v, real3 wo, real2 xi)
{
    // a, b: take a point on the disk, move it to the crescent inside the lune's outline, and lift it to the sphere. The
    // lune has the share s of the disk's width. edge^2 - disk.x^2 = 1 - r^2, so nothing here is a difference of squares.
    // Squares would leave few digits at the rim, and for narrow lobes that tilt away, whose lunes are thin.
    real2 disk = concentric_disk(xi);
    real rest = concentric_rest(xi);
    real edge = sqrt(rest + disk.x * disk.x);
    real wide = edge + abs(disk.x);
    real thin = rest / max(wide, lit(1e-20));
    real to_outline = select(disk.x > lit(0.0), thin, wide);
    real to_rim = select(disk.x > lit(0.0), wide, thin);
    real half_lengths = lit(0.5) / max(v.lengths, lit(1e-20));
    real s = min(half_lengths * v.sum, lit(1.0));
    real x = edge - s * to_outline;
    real z = sqrt(max(s * to_outline * (to_rim + half_lengths * v.hidden * to_outline), lit(0.0)));
    // c: build the lune's frame. Seen along the normal, the lune is half a sphere, and any e2 perpendicular to e3 will do.
    real3 e3 = k_normalize3(v.au);
    real3 side = vec3_of(wo.y, -wo.x, lit(0.0));
    mask along_x = abs(e3.x) > lit(0.9);
    real3 across = vec3_of(select(along_x, lit(0.0), lit(1.0)), select(along_x, lit(1.0), lit(0.0)), lit(0.0));
    mask collinear = k_dot3(side, side) < lit(1e-12);
    // The cofactor shrinks by up to alpha^2, so divide by its argument's length, kept above 1e-6.
    real3 turned = ellipsoid_cofactor(p, side) / sqrt(max(k_dot3(side, side), lit(1e-12)));
    real3 e2 = k_normalize3(select(collinear, k_cross(e3, across), turned));
    real3 e1 = k_cross(e2, e3);
    // d: map back to the ellipsoid, A^T p_c.
    real3 point = e1 * x + e2 * disk.y + e3 * z;
    real3 m = p.r0 * (p.alpha_x * point.x) + p.r1 * (p.alpha_y * point.y) + p.r2 * point.z;
    return k_normalize3(m);
}

// Samples wi. The weight, G1(wi) min(1, 1 / (k wo.z)), is at most 1 (Eq. 50 to 52).
BN_FN bsdf_sample ellipsoid_sample(ellipsoid_params p, real3 wo, real2 xi)
{
    ellipsoid_view v = ellipsoid_seen_from(p, wo);
    real3 m = ellipsoid_visible_normal(p, v, wo, xi);
    real3 wi = mirror_direction(wo, m);
    real o_dot_m = k_dot3(wo, m);
    real weight = ellipsoid_g1(p, wi) * min(lit(1.0) / max(v.k * wo.z, lit(1e-16)), lit(1.0));
    real pdf = lit(0.25) * v.k * ellipsoid_d(p, m);
    mask valid = both(both_above(wo, wi), both(o_dot_m > lit(0.0), m.z > lit(0.0)));
    return bsdf_sample_of(wi, weight, pdf, o_dot_m, valid);
}

// Returns directional albedo in the mirror limit: the weight of its only sample.
BN_FN real ellipsoid_mirror_albedo(ellipsoid_params p, real3 wo)
{
    ellipsoid_view v = ellipsoid_seen_from(p, wo);
    real3 wi = mirror_direction(wo, p.r2);
    real weight = ellipsoid_g1(p, wi) * min(lit(1.0) / max(v.k * wo.z, lit(1e-16)), lit(1.0));
    mask seen = both(both_above(wo, wi), k_dot3(wo, p.r2) > lit(0.0));
    return select(seen, weight, lit(0.0));
}

BN_KERNELS_END

#endif
