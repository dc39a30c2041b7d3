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

// What scatters from wo to wi, without Fresnel's factor: reflectance where it is reflected, the rest where it crosses.
struct ellipsoid_scattering {
    real value;   // 1/sr, of a perfect reflector and of an interface that reflects nothing
    real pdf;     // of the side's samples, 1/sr
    real o_dot_m; // of the microfacet: the argument of Fresnel's equations
    mask transmits;
};

BN_FN ellipsoid_scattering ellipsoid_scattering_of(ellipsoid_dielectric_params p, real3 wo, real3 wi)
{
    ellipsoid_crossing c = ellipsoid_crossing_of(p, wo, wi);
    ellipsoid_scattering s;
    s.transmits = c.transmits;
    s.o_dot_m = max(k_dot3(c.wo, c.m), lit(0.0));
    real side = select(c.transmits, s.o_dot_m * ellipsoid_refraction_jacobian(c), lit(0.25));
    real d = ellipsoid_d(p.shape, c.m);
    real masked = d * ellipsoid_g1_over_z(p.shape, c.wo) * ellipsoid_g1_over_z(p.shape, ellipsoid_masked_as(c));
    ellipsoid_view v = ellipsoid_seen_from(p.shape, c.wo);
    real seen = v.k * d;
    s.value = select(c.possible, masked * side, lit(0.0));
    s.pdf = select(c.possible, seen * side, lit(0.0));
    return s;
}

// Its share of the light that meets the microfacet.
BN_FN real ellipsoid_dielectric_share(ellipsoid_dielectric_params p, real3 wo, ellipsoid_scattering s)
{
    real eta = select(wo.z < lit(0.0), lit(1.0) / p.eta, p.eta);
    real f = fresnel_dielectric(s.o_dot_m, eta);
    return select(s.transmits, lit(1.0) - f, f);
}

BN_FN real ellipsoid_dielectric_eval(ellipsoid_dielectric_params p, real3 wo, real3 wi)
{
    ellipsoid_scattering s = ellipsoid_scattering_of(p, wo, wi);
    return ellipsoid_dielectric_share(p, wo, s) * s.value;
}

BN_FN real ellipsoid_dielectric_pdf(ellipsoid_dielectric_params p, real3 wo, real3 wi)
{
    ellipsoid_scattering s = ellipsoid_scattering_of(p, wo, wi);
    return ellipsoid_dielectric_share(p, wo, s) * s.pdf;
}

// A microfacet that wo, above the surface, sees.
struct ellipsoid_facet {
    real3 m; // its normal, unit
    real o_dot_m;
    real seen;     // density of m over o_dot_m
    real lit_part; // of it, by wo's masking: min(1, 1 / (k wo.z))
    mask sound;
};

// v: ellipsoid_seen_from(shape, wo).
BN_FN ellipsoid_facet ellipsoid_facet_of(ellipsoid_params shape, ellipsoid_view v, real3 wo, real3 m)
{
    ellipsoid_facet r;
    r.m = m;
    r.o_dot_m = max(k_dot3(wo, m), lit(0.0));
    r.seen = v.k * ellipsoid_d(shape, m);
    r.lit_part = min(lit(1.0) / max(v.k * wo.z, lit(1e-16)), lit(1.0));
    r.sound = both(wo.z > lit(0.0), both(r.o_dot_m > lit(0.0), m.z > lit(0.0)));
    return r;
}

BN_FN ellipsoid_facet ellipsoid_facet_seen(ellipsoid_params shape, real3 wo, real2 xi)
{
    ellipsoid_view v = ellipsoid_seen_from(shape, wo);
    return ellipsoid_facet_of(shape, v, wo, ellipsoid_visible_normal(shape, v, wo, xi));
}

// Samples through a microfacet, without Fresnel's factor in weight and density. The weight is G1(wi) min(1, 1 / (k wo.z)).
BN_FN bsdf_sample ellipsoid_facet_reflects(ellipsoid_params shape, ellipsoid_facet f, real3 wo)
{
    real3 wi = mirror_direction(wo, f.m);
    real weight = ellipsoid_g1(shape, wi) * f.lit_part;
    real pdf = lit(0.25) * f.seen;
    return bsdf_sample_of(wi, weight, pdf, f.o_dot_m, both(f.sound, wi.z > lit(0.0)));
}

// eta: index of the far side over that of wo's.
BN_FN bsdf_sample ellipsoid_facet_refracts(ellipsoid_params shape, ellipsoid_facet f, real3 wo, real eta)
{
    real sine2 = max((lit(1.0) - f.o_dot_m) * (lit(1.0) + f.o_dot_m), lit(0.0)) / (eta * eta);
    real cosine = sqrt(max(lit(1.0) - sine2, lit(0.0))); // of the refracted direction, below the facet
    real3 wi = k_normalize3(f.m * (f.o_dot_m / eta - cosine) - wo / eta);
    real weight = ellipsoid_g1(shape, -wi) * f.lit_part;
    real travel = eta * cosine - f.o_dot_m; // |wo + eta wi|
    real jacobian = eta * eta * cosine / max(travel * travel, lit(1e-12));
    real pdf = f.seen * f.o_dot_m * jacobian;
    mask below = both(wi.z < lit(0.0), sine2 < lit(1.0));
    return bsdf_sample_of(wi, weight, pdf, f.o_dot_m, both(f.sound, below));
}

// xi.x, xi.y choose the microfacet, xi.z between reflection and refraction.
BN_FN bsdf_sample ellipsoid_dielectric_sample(ellipsoid_dielectric_params p, real3 wo, real3 xi)
{
    mask under = wo.z < lit(0.0);
    real3 up = select(under, -wo, wo);
    real eta = select(under, lit(1.0) / p.eta, p.eta);
    ellipsoid_facet m = ellipsoid_facet_seen(p.shape, up, vec2_of(xi.x, xi.y));
    real f = fresnel_dielectric(m.o_dot_m, eta);
    mask reflects = xi.z < f;
    bsdf_sample r = ellipsoid_facet_reflects(p.shape, m, up);
    bsdf_sample t = ellipsoid_facet_refracts(p.shape, m, up, eta);
    real3 wi = select(reflects, r.wi, t.wi);
    real weight = select(reflects, r.weight, t.weight);
    real pdf = select(reflects, f * r.pdf, (lit(1.0) - f) * t.pdf);
    mask valid = either(both(reflects, r.valid), both(not_(reflects), t.valid));
    return bsdf_sample_of(select(under, -wi, wi), weight, pdf, m.o_dot_m, valid);
}

BN_KERNELS_END

#endif
