// A rough dielectric interface whose microfacets follow the ellipsoid distribution: reflection and refraction
// with exact Fresnel factors. Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces",
// eq. 16, 17 and 21, with the masking of the ellipsoid's Eq. 7: a direction below the surface is masked like
// its opposite. Here f is the density of scattered power: the integral of f |wi.z| over all wi is at most 1,
// and so is a sample's weight. A path traced from the eye carries radiance, which changes by the square of
// the index: multiply by (eta of wo's side / eta of wi's side)^2. Directions as in microfacet.k.h, but wo and
// wi may each lie on either side.
#ifndef BN_ELLIPSOID_DIELECTRIC_K_H
#define BN_ELLIPSOID_DIELECTRIC_K_H

#include "shading/kernels/fresnel.k.h"
#include "shading/lang/lang.h"
#include "shading/models/ellipsoid.k.h"

BN_KERNELS_BEGIN

struct ellipsoid_dielectric_params {
    ellipsoid_params shape;
    real eta; // index below the surface over that above it, [0.1, 10], at least 1e-3 from 1, where nothing
              // would be scattered
};

BN_FN ellipsoid_dielectric_params ellipsoid_dielectric_params_of(ellipsoid_params shape, real eta)
{
    ellipsoid_dielectric_params p;
    p.shape = shape;
    real e = min(max(eta, lit(0.1)), lit(10.0));
    real away = select(e < lit(1.0), lit(0.999), lit(1.001));
    p.eta = select(abs(e - lit(1.0)) < lit(1e-3), away, e);
    return p;
}

// Both directions turned over if wo is below, so that it is above: the surface looks the same from there but
// for the index.
struct ellipsoid_crossing {
    real3 wo;
    real3 wi;
    real eta; // index of the far side over that of wo's
    mask transmits;
    mask possible; // neither lies in the surface
    real3 m;       // the microfacet's normal, unit, m.z >= 0 where there is one
    real length2;  // |wo + eta wi|^2 where the light crosses
};

BN_FN ellipsoid_crossing ellipsoid_crossing_of(ellipsoid_dielectric_params p, real3 wo, real3 wi)
{
    ellipsoid_crossing c;
    mask under = wo.z < lit(0.0);
    c.wo = select(under, -wo, wo);
    c.wi = select(under, -wi, wi);
    c.eta = select(under, lit(1.0) / p.eta, p.eta);
    c.transmits = c.wi.z < lit(0.0);
    c.possible = both(c.wo.z > lit(0.0), either(c.wi.z > lit(0.0), c.wi.z < lit(0.0)));
    real3 h = c.wo + select(c.transmits, c.wi * c.eta, c.wi);
    c.length2 = max(k_dot3(h, h), lit(1e-12));
    real3 m = k_normalize3(h);
    c.m = select(m.z < lit(0.0), -m, m);
    return c;
}

// wi below the surface, masked like its opposite.
BN_FN real3 ellipsoid_masked_as(ellipsoid_crossing c)
{
    return select(c.transmits, -c.wi, c.wi);
}

// Jacobian of refraction, dm / dwi, with wo.m: sr/sr. Zero where wo and wi do not lie on opposite sides of
// the facet.
BN_FN real ellipsoid_refraction_jacobian(ellipsoid_crossing c)
{
    real i_dot_m = k_dot3(c.wi, c.m);
    real o_dot_m = k_dot3(c.wo, c.m);
    real value = c.eta * c.eta * abs(i_dot_m) / c.length2;
    return select(both(i_dot_m<lit(0.0), o_dot_m> lit(0.0)), value, lit(0.0));
}

BN_FN real ellipsoid_dielectric_eval(ellipsoid_dielectric_params p, real3 wo, real3 wi)
{
    ellipsoid_crossing c = ellipsoid_crossing_of(p, wo, wi);
    real o_dot_m = max(k_dot3(c.wo, c.m), lit(0.0));
    real f = fresnel_dielectric(o_dot_m, c.eta);
    real shared_part =
        ellipsoid_d(p.shape, c.m) * ellipsoid_g1_over_z(p.shape, c.wo) * ellipsoid_g1_over_z(p.shape, ellipsoid_masked_as(c));
    real reflected = lit(0.25) * f * shared_part;
    real refracted = (lit(1.0) - f) * shared_part * o_dot_m * ellipsoid_refraction_jacobian(c);
    return select(c.possible, select(c.transmits, refracted, reflected), lit(0.0));
}

BN_FN real ellipsoid_dielectric_pdf(ellipsoid_dielectric_params p, real3 wo, real3 wi)
{
    ellipsoid_crossing c = ellipsoid_crossing_of(p, wo, wi);
    real o_dot_m = max(k_dot3(c.wo, c.m), lit(0.0));
    real f = fresnel_dielectric(o_dot_m, c.eta);
    ellipsoid_view v = ellipsoid_seen_from(p.shape, c.wo);
    real seen = v.k * ellipsoid_d(p.shape, c.m);
    real reflected = lit(0.25) * f * seen;
    real refracted = (lit(1.0) - f) * seen * o_dot_m * ellipsoid_refraction_jacobian(c);
    return select(c.possible, select(c.transmits, refracted, reflected), lit(0.0));
}

// xi.x, xi.y choose the microfacet, xi.z between reflection and refraction. The weight is G1(wi) min(1, 1 /
// (k |wo.z|)).
BN_FN bsdf_sample ellipsoid_dielectric_sample(ellipsoid_dielectric_params p, real3 wo, real3 xi)
{
    mask under = wo.z < lit(0.0);
    real3 up = select(under, -wo, wo);
    real eta = select(under, lit(1.0) / p.eta, p.eta);
    ellipsoid_view v = ellipsoid_seen_from(p.shape, up);
    real3 m = ellipsoid_visible_normal(p.shape, v, up, vec2_of(xi.x, xi.y));
    real o_dot_m = max(k_dot3(up, m), lit(0.0));
    real f = fresnel_dielectric(o_dot_m, eta);
    mask reflects = xi.z < f;
    real sine2 = max((lit(1.0) - o_dot_m) * (lit(1.0) + o_dot_m), lit(0.0)) / (eta * eta);
    real cosine = sqrt(max(lit(1.0) - sine2, lit(0.0))); // of the refracted direction, below the facet
    real3 through = k_normalize3(m * (o_dot_m / eta - cosine) - up / eta);
    real3 wi = select(reflects, mirror_direction(up, m), through);
    real3 masked = select(reflects, wi, -wi);
    real weight = ellipsoid_g1(p.shape, masked) * min(lit(1.0) / max(v.k * up.z, lit(1e-16)), lit(1.0));
    real travel = eta * cosine - o_dot_m; // |wo + eta wi|
    real jacobian = eta * eta * cosine / max(travel * travel, lit(1e-12));
    real seen = v.k * ellipsoid_d(p.shape, m);
    real pdf = select(reflects, lit(0.25) * f * seen, (lit(1.0) - f) * seen * o_dot_m * jacobian);
    mask sides = both(both_above(up, masked), both(o_dot_m > lit(0.0), m.z > lit(0.0)));
    return bsdf_sample_of(select(under, -wi, wi), weight, pdf, o_dot_m, sides);
}

BN_KERNELS_END

#endif
