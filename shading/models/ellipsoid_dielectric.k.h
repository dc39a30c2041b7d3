// A rough dielectric interface whose microfacets follow the ellipsoid distribution: reflection and refraction with exact
// Fresnel factors. Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 16, 17 and 21, with
// the ellipsoid's masking (Eq. 7): a direction below the surface is masked like its opposite. Here f is the density of
// scattered power. So the integral of f |wi.z| over all wi is at most 1, and so is a sample's weight. A path traced from
// the eye carries radiance, which changes by the squared index: multiply by (eta of wo's side / eta of wi's side)^2.
// Directions as in microfacet.k.h, but wo and wi may lie on either side.
#ifndef BN_ELLIPSOID_DIELECTRIC_K_H
#define BN_ELLIPSOID_DIELECTRIC_K_H

#include "shading/kernels/fresnel.k.h"
#include "shading/lang/lang.h"
#include "shading/models/ellipsoid.k.h"

BN_KERNELS_BEGIN

struct ellipsoid_dielectric_params {
    ellipsoid_params shape;
    real eta; // index below the surface over the index above, [0.1, 10], at least 1e-3 from 1, where nothing would scatter
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

// Both directions, flipped if wo is below so that wo is above: except for the index, the surface looks the same from there.
struct ellipsoid_crossing {
    real3 wo;
    real3 wi;
    real eta; // index on the far side over the index on wo's side
    mask transmits;
    mask possible; // neither direction lies in the surface
    real3 m;       // the microfacet normal, unit, m.z >= 0 where it exists
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

// Returns wi, or its opposite where wi lies below the surface, for masking.
BN_FN real3 ellipsoid_masked_as(ellipsoid_crossing c)
{
    return select(c.transmits, -c.wi, c.wi);
}

// Returns the Jacobian of refraction, dm / dwi, sr/sr. Zero where wo and wi do not lie on opposite sides of the facet.
BN_FN real ellipsoid_refraction_jacobian(ellipsoid_crossing c)
{
    real i_dot_m = k_dot3(c.wi, c.m);
    real o_dot_m = k_dot3(c.wo, c.m);
    real value = c.eta * c.eta * abs(i_dot_m) / c.length2;
    return select(both(i_dot_m<lit(0.0), o_dot_m> lit(0.0)), value, lit(0.0));
}

// Scattering from wo to wi, without the Fresnel factor F for reflection and 1 - F for refraction.
struct ellipsoid_scattering {
    real value;   // 1/sr, for a perfect reflector or an interface that reflects nothing
    real pdf;     // density of this side's samples, 1/sr
    real o_dot_m; // cosine to the microfacet: the argument of Fresnel's equations
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

// Returns the share of light at the microfacet that goes this way: F or 1 - F.
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

// A microfacet that wo sees; wo lies above the surface.
struct ellipsoid_facet {
    real3 m; // the microfacet normal, unit
    real o_dot_m;
    real seen;     // density of m over o_dot_m
    real lit_part; // factor on the weight by wo's masking: min(1, 1 / (k wo.z))
    mask sound;
};

// Makes the facet with normal m. v: ellipsoid_seen_from(shape, wo).
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

// Samples reflection at a microfacet, without the Fresnel factor in weight and density. The weight is G1(wi) min(1, 1 / (k
// wo.z)).
BN_FN bsdf_sample ellipsoid_facet_reflects(ellipsoid_params shape, ellipsoid_facet f, real3 wo)
{
    real3 wi = mirror_direction(wo, f.m);
    real weight = ellipsoid_g1(shape, wi) * f.lit_part;
    real pdf = lit(0.25) * f.seen;
    return bsdf_sample_of(wi, weight, pdf, f.o_dot_m, both(f.sound, wi.z > lit(0.0)));
}

// Samples refraction at a microfacet, likewise. eta: index on the far side over the index on wo's side.
BN_FN bsdf_sample ellipsoid_facet_refracts(ellipsoid_params shape, ellipsoid_facet f, real3 wo, real eta)
{
    real sine2 = max((lit(1.0) - f.o_dot_m) * (lit(1.0) + f.o_dot_m), lit(0.0)) / (eta * eta);
    real cosine = sqrt(max(lit(1.0) - sine2, lit(0.0))); // cosine of the refracted direction, below the facet
    real3 wi = k_normalize3(f.m * (f.o_dot_m / eta - cosine) - wo / eta);
    real weight = ellipsoid_g1(shape, -wi) * f.lit_part;
    real travel = eta * cosine - f.o_dot_m; // |wo + eta wi|
    real jacobian = eta * eta * cosine / max(travel * travel, lit(1e-12));
    real pdf = f.seen * f.o_dot_m * jacobian;
    mask below = both(wi.z < lit(0.0), sine2 < lit(1.0));
    return bsdf_sample_of(wi, weight, pdf, f.o_dot_m, both(f.sound, below));
}

// Samples wi. xi.x, xi.y choose the microfacet, xi.z chooses between reflection and refraction.
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
