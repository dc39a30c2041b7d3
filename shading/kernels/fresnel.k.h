// Reflectance of a smooth interface: Schlick's approximation, and the exact equations for dielectrics and conductors in
// forms that do not cancel in float32. All for unpolarised light; v_dot_h is the cosine to the microfacet, [0,1].
#ifndef BN_FRESNEL_K_H
#define BN_FRESNEL_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Returns Schlick's approximation. f0, f90: reflectance at normal and grazing incidence. Schlick 1994, "An Inexpensive BRDF
// Model for Physically-based Rendering".
BN_FN real3 fresnel_schlick(real3 f0, real3 f90, real v_dot_h)
{
    real m = lit(1.0) - v_dot_h;
    real m2 = m * m;
    real m5 = m2 * m2 * m;
    return f0 + (f90 - f0) * m5;
}

// Returns a dielectric's reflectance at normal incidence. eta > 0: the far side's index over the near side's.
BN_FN real fresnel_f0(real eta)
{
    real r = (eta - lit(1.0)) / (eta + lit(1.0));
    return r * r;
}

// Returns index2 - sin^2, where index2 - 1 = contrast. Each half of the cosine range uses the form that keeps its digits at
// the onset of total reflection and at index 1.
BN_FN real fresnel_inside(real c, real s2, real index2, real contrast)
{
    return select(c > lit(0.7), index2 - s2, contrast + c * c);
}

// Returns a dielectric's exact reflectance, with total internal reflection. eta > 0 as above. Let c = v_dot_h and g = eta
// cos(refracted angle). The amplitudes (c - g) / (c + g) and (eta^2 c - g) / (eta^2 c + g) are written without differences
// between nearly equal numbers: c^2 - g^2 = 1 - eta^2, and eta^4 c^2 - g^2 equals (eta^2 - 1) (eta^2 c^2 - sin^2).
BN_FN real fresnel_dielectric(real v_dot_h, real eta)
{
    real c = k_saturate(v_dot_h);
    real e2 = eta * eta;
    real contrast = (eta - lit(1.0)) * (eta + lit(1.0));
    real s2 = (lit(1.0) - c) * (lit(1.0) + c);
    real g2 = fresnel_inside(c, s2, e2, contrast);
    real g = sqrt(max(g2, lit(0.0)));
    real sum_s = max(c + g, lit(1e-12));
    real sum_p = max(e2 * c + g, lit(1e-12));
    real rs = contrast / sum_s / sum_s;
    real rp = contrast * (e2 * c * c - s2) / sum_p / sum_p;
    real value = min(lit(0.5) * (rs * rs + rp * rp), lit(1.0));
    return select(both(g2 <= lit(0.0), contrast < lit(0.0)), lit(1.0), value);
}

// Returns a conductor's exact reflectance. Index eta + i k over the near side's index, eta >= 0, k >= 0, both at most 1e4.
// Born and Wolf 1999, "Principles of Optics", section 14.2: (a + i b)^2 = (eta + i k)^2 - sin^2. The smaller of a and b
// follows from a b = eta k, and a - c from a^2 - c^2 = eta^2 - k^2 - 1 + b^2. So nothing cancels, not even at eta = 1, k =
// 0.
BN_FN real fresnel_conductor(real v_dot_h, real eta, real k)
{
    real c = k_saturate(v_dot_h);
    real s2 = (lit(1.0) - c) * (lit(1.0) + c);
    real contrast = (eta - lit(1.0)) * (eta + lit(1.0)) - k * k;
    real t = fresnel_inside(c, s2, (eta - k) * (eta + k), contrast);
    real ek = eta * k;
    real modulus = sqrt(t * t + lit(4.0) * ek * ek);
    real larger = sqrt(lit(0.5) * (modulus + abs(t)));
    real smaller = ek / max(larger, lit(1e-12));
    mask refracts = t >= lit(0.0);
    real a = select(refracts, larger, smaller);
    real b = select(refracts, smaller, larger);
    real b2 = b * b;
    real ac = max(a + c, lit(1e-12));
    real down_s = (contrast + b2) / ac;
    real rs = (down_s * down_s + b2) / max(ac * ac + b2, lit(1e-24));
    real bc2 = b2 * c * c;
    real down_p = a * c - s2;
    real up_p = a * c + s2;
    real bottom = up_p * up_p + bc2;
    real rp = select(bottom > lit(1e-24), (down_p * down_p + bc2) / max(bottom, lit(1e-24)), lit(1.0)) * rs;
    return min(lit(0.5) * (rs + rp), lit(1.0));
}

// Returns a conductor's reflectance per colour channel.
BN_FN real3 fresnel_conductor3(real v_dot_h, real3 eta, real3 k)
{
    return vec3_of(fresnel_conductor(v_dot_h, eta.x, k.x), fresnel_conductor(v_dot_h, eta.y, k.y), fresnel_conductor(v_dot_h, eta.z, k.z));
}

BN_KERNELS_END

#endif
