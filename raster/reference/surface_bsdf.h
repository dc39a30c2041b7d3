// A surface's BSDF, as technique `mc` samples it: one term for the lobe (bsdf_lobe.t.h, reflectance.t.h) or for a rough interface that
// transmits light too (refraction.t.h), a diffuse term, and coatings above (coating.t.h). Gives values, densities and samples. Directions
// are world space, unit.
#pragma once
#include "raster/reference/samples.h"
#include "shading/models/lambert.k.h"
#include "shading/surface/coating.t.h"
#include "shading/surface/shaded_point.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct SurfaceBsdf {
    shaded_point x;
    int lobe;      // the frame's, index in shading/models.def
    real3 o;       // to the eye, in the lobe's frame
    real3 horizon; // surface normal before normal maps and tilts: nothing below its horizon is reflected
    real3 diffuse; // BRDF of the diffuse part, 1/sr; with phong_diffuse, lit light is also multiplied by phong_diffuse_lit()
    bool phong_diffuse;
    real choose_specular;           // probability
    mask mirror;                    // the lobe has no width: only samples meet it
    mask refracts;                  // an interface replaces the lobe; empty if !x.transmission.refracts
    int coatings;                   // bit i: some lanes have coating i of shading/coatings.def
    coating coats[kCoatings];       // valid where the bit is set; share 0 in lanes without the coating
    real choose_coating[kCoatings]; // probability, once no higher coating is chosen
};

constexpr int kDefaultLobeIndex = lobe_with(kDefaultLobe);
constexpr int kCoatingLobes[] = {
#define BN_COATING(id, at, strength, lobe) kLobe_##lobe,
#include "shading/coatings.def"
};

BN_INLINE real luminance_of(real3 c)
{
    return c.x * lit(0.2126) + c.y * lit(0.7152) + c.z * lit(0.0722);
}

BN_INLINE bool has_coating(const SurfaceBsdf& r, int at)
{
    return (r.coatings >> at & 1) != 0;
}

// Puts the coating `at` over r. reflected: luminance of the light that r reflects; the coating adds its share.
BN_INLINE void add_coating(SurfaceBsdf& r, int at, const coating& c, real& reflected)
{
    const real below = (lit(1.0) - c.share) * reflected;
    const real all = c.share + below;
    const real part = min(max(c.share / max(all, lit(1e-20)), lit(0.1)), lit(0.9));
    r.coatings |= 1 << at;
    r.coats[at] = c;
    r.choose_coating[at] = select(c.share > lit(0.0), part, lit(0.0));
    reflected = all;
}

// Makes a material's BSDF without coatings. reflected: receives the luminance of the light that it reflects.
BN_INLINE SurfaceBsdf make_surface_bsdf(const ShadingFrame& f, const shaded_point& x, real& reflected)
{
    SurfaceBsdf r;
    const surface& s = x.s;
    r.x = x, r.lobe = f.lobe;
    r.horizon = x.has_surface_horizon ? x.geometric_axes.n : s.n;
    r.o = make_bsdf_lobe(kDefaultLobeIndex, x.lobe, s.n, s.v, x.geometric_axes).o;
    const real passed = diffuse_energy_share(f, x);
    r.phong_diffuse = f.diffuse_model != 0;
    r.diffuse = diffuse_brdf(f, x);
    r.mirror = x.lobe.sigma_u + x.lobe.sigma_v <= lit(1e-6);
    if (lobe_has(f.lobe, kBroadLobe)) // has a least width
        r.mirror = mask_from_bits(0);
    r.refracts = mask_from_bits(x.transmission.refracts ? (1u << kLanes) - 1u : 0u);
    // Choose terms by their reflected energy
    real specular = luminance_of((s.f0 * x.energy.dfg.scale + s.f90 * x.energy.dfg.bias) * x.energy.gain);
    if (x.transmission.refracts)
        specular = specular + luminance_of(x.transmission.inputs.tint) * passed;
    const real rest = luminance_of(s.diffuse) * passed;
    const real share = specular / max(specular + rest, lit(1e-20));
    r.choose_specular = select(rest > lit(1e-6), select(specular > lit(1e-6), min(max(share, lit(0.1)), lit(0.9)), lit(0.0)), lit(1.0));
    if (lobe_has(f.lobe, kPunctualOnly))
        r.choose_specular = lit(0.0);
    // Start without coatings
    r.coatings = 0;
    for (int k = 0; k < kCoatings; ++k) {
        r.coats[k] = {x.geometric_axes, x.geometric_axes.n, false, vec3_all(lit(0.0)), lit(0.0), lit(1.0)};
        r.choose_coating[k] = lit(0.0);
    }
    reflected = specular + rest;
    return r;
}

// Returns a coating's lobe. A smooth coating gets the lobe model's least width, so that it is never a mirror.
BN_INLINE bsdf_lobe coating_lobe_of(const SurfaceBsdf& r, int at)
{
    const coating& c = r.coats[at];
    const real sigma = c.roughness * c.roughness * lit(0.70710678118654752);
    const aniso_lobe lobe = {c.axes.t, c.axes.b, sigma, sigma};
    return make_bsdf_lobe(kCoatingLobes[at], lobe, c.axes.n, r.x.s.v, c.axes);
}

BN_INLINE bsdf_lobe lobe_of(const SurfaceBsdf& r, int model)
{
    bsdf_lobe a = make_bsdf_lobe(model, r.x.lobe, r.x.s.n, r.x.s.v, r.x.geometric_axes);
    if (!lobe_has(model, kLies_surface))
        a.o = r.o; // already computed
    return a;
}

struct LobeValue {
    real value, pdf, o_dot_h; // value: without Fresnel, times the cosine
};

BN_INLINE LobeValue value_of(const bsdf_lobe& a, real3 wi)
{
    return {bsdf_lobe_eval_cos(a, wi), bsdf_lobe_pdf(a, wi), bsdf_lobe_o_dot_h(a, wi)};
}

// The default lobe is inlined; other lobes stay out of line.
BN_STAGE LobeValue other_lobe_value(const SurfaceBsdf& r, real3 wi)
{
    return value_of(lobe_of(r, r.lobe), wi);
}

BN_STAGE real3 other_lobe_sample(const SurfaceBsdf& r, real2 xi)
{
    return bsdf_lobe_sample(lobe_of(r, r.lobe), xi).wi;
}

BN_INLINE LobeValue lobe_value(const SurfaceBsdf& r, real3 wi)
{
    return r.lobe == kDefaultLobeIndex ? value_of(lobe_of(r, kDefaultLobeIndex), wi) : other_lobe_value(r, wi);
}

BN_INLINE real3 lobe_sample(const SurfaceBsdf& r, real2 xi)
{
    return r.lobe == kDefaultLobeIndex ? bsdf_lobe_sample(lobe_of(r, kDefaultLobeIndex), xi).wi : other_lobe_sample(r, xi);
}

struct Reflection {
    real3 value; // BRDF times the cosine, 1/sr
    real pdf;    // of sample_surface_bsdf(), 1/sr
};

// Returns the probability that an interface sample is the microfacet's reflection.
BN_INLINE real reflecting_share(const rough_interface& g, real o_dot_m)
{
    const real reflected = luminance_of(interface_reflects(g.at, o_dot_m)), passed = luminance_of(interface_passes(g.at, o_dot_m));
    return reflected / max(reflected + passed, lit(1e-20));
}

// Evaluates the interface, which replaces the lobe's value and density.
BN_STAGE Reflection scatter(const SurfaceBsdf& r, real3 wi)
{
    const rough_interface g = rough_interface_at(r.x);
    const real3 i = to_frame(g.axes, wi);
    const ellipsoid_scattering s = ellipsoid_scattering_of(g.p, g.o, i);
    const real3 share = select(s.transmits, interface_passes(g.at, s.o_dot_m), interface_reflects(g.at, s.o_dot_m));
    const real reflecting = reflecting_share(g, s.o_dot_m);
    Reflection to;
    to.value = select(r.mirror, vec3_all(lit(0.0)), share * r.x.energy.gain * (s.value * abs(i.z)));
    to.pdf = select(r.mirror, lit(0.0), s.pdf * select(s.transmits, lit(1.0) - reflecting, reflecting));
    return to;
}

// Evaluates everything below the coatings, except a mirror's reflection.
BN_INLINE Reflection reflect_below(const SurfaceBsdf& r, real3 wi)
{
    const LobeValue l = lobe_value(r, wi);
    mask shines = both(not_(r.mirror), k_dot3(r.horizon, wi) > lit(0.0));
    if (lobe_has(r.lobe, kPunctualOnly))
        shines = mask_from_bits(0);
    const real lobe = select(shines, l.value, lit(0.0));
    const real3 fresnel = reflectance_of(r.x.s, k_saturate(l.o_dot_h));
    const real cosine = max(k_dot3(r.x.s.n, wi), lit(0.0));
    real3 specular = fresnel * r.x.energy.gain * lobe;
    real specular_pdf = select(r.mirror, lit(0.0), l.pdf);
    if (r.x.transmission.refracts) {
        const Reflection s = scatter(r, wi);
        specular = select(r.refracts, s.value, specular);
        specular_pdf = select(r.refracts, s.pdf, specular_pdf);
    }
    Reflection to;
    const real fallen = select(k_dot3(r.horizon, wi) > lit(0.0), cosine, lit(0.0));
    to.value = specular + r.diffuse * (r.phong_diffuse ? fallen * phong_diffuse_lit(cosine) : fallen);
    to.pdf = r.choose_specular * specular_pdf + (lit(1.0) - r.choose_specular) * cosine * lit(0.31830988618379067);
    return to;
}

// Adds the coatings, from the lowest to the highest.
BN_STAGE Reflection reflect_coated(const SurfaceBsdf& r, real3 wi, const Reflection& below)
{
    Reflection to = below;
    for (int k = 0; k < kCoatings; ++k) {
        if (!has_coating(r, k))
            continue;
        const coating& c = r.coats[k];
        const LobeValue l = value_of(coating_lobe_of(r, k), wi);
        const mask shines = k_dot3(c.horizon, wi) > lit(0.0);
        to.value = to.value * (lit(1.0) - c.share) + select(shines, c.reflectance * l.value, vec3_all(lit(0.0)));
        to.pdf = r.choose_coating[k] * l.pdf + (lit(1.0) - r.choose_coating[k]) * to.pdf;
    }
    return to;
}

BN_INLINE Reflection reflect(const SurfaceBsdf& r, real3 wi)
{
    const Reflection below = reflect_below(r, wi);
    return r.coatings != 0 ? reflect_coated(r, wi, below) : below;
}

struct SurfaceBsdfSample {
    real3 wi;
    real3 weight; // value / pdf, 0 for an invalid sample
    real pdf;     // 1/sr; meaningless if exact
    mask exact;   // a mirror's direction, which no other strategy finds
    mask alone;   // weight and pdf belong to the only term in this direction: the mirror or an interface
};

struct InterfaceSample {
    real3 wi;
    real3 weight; // value / pdf
    real pdf;
    mask alone; // no other term of the surface reaches this direction
};

// Samples the interface. choice: in [0,1), selects reflection or transmission.
BN_STAGE InterfaceSample sample_interface(const SurfaceBsdf& r, real2 xi, real choice)
{
    const rough_interface g = rough_interface_at(r.x);
    const ellipsoid_view v = ellipsoid_seen_from(g.p.shape, g.o);
    const real3 normal = select(r.mirror, g.n, ellipsoid_visible_normal(g.p.shape, v, g.o, xi));
    const ellipsoid_facet m = ellipsoid_facet_of(g.p.shape, v, g.o, normal);
    const bsdf_sample up = ellipsoid_facet_reflects(g.p.shape, m, g.o), down = ellipsoid_facet_refracts(g.p.shape, m, g.o, g.p.eta);
    const real reflecting = reflecting_share(g, m.o_dot_m), passing = lit(1.0) - reflecting;
    const mask reflects = choice < reflecting;
    const real3 reflected = interface_reflects(g.at, m.o_dot_m) * (up.weight / max(reflecting, lit(1e-20)));
    const real3 passed = interface_passes(g.at, m.o_dot_m) * (down.weight / max(passing, lit(1e-20)));
    InterfaceSample s;
    s.wi = from_frame(g.axes, select(reflects, up.wi, down.wi));
    s.weight = select(reflects, reflected, passed) * r.x.energy.gain;
    s.pdf = select(reflects, up.pdf * reflecting, down.pdf * passing);
    s.alone = either(either(not_(reflects), r.mirror), not_(up.valid));
    return s;
}

BN_INLINE SurfaceBsdfSample sample_below(const SurfaceBsdf& r, real2 xi, real choice)
{
    // Draw one direction per term, and select
    const mask specular = choice < r.choose_specular;
    const real3 mirrored = from_lobe(r.x.lobe, r.x.s.n, mirror_direction(r.o, vec3_of(lit(0.0), lit(0.0), lit(1.0))));
    const real3 shiny = lobe_sample(r, xi);
    const real3 dull = from_lobe(r.x.lobe, r.x.s.n, lambert_sample(r.o, xi).wi);
    SurfaceBsdfSample s;
    s.wi = k_normalize3(select(specular, select(r.mirror, mirrored, shiny), dull));
    InterfaceSample through;
    if (r.x.transmission.refracts) {
        through = sample_interface(r, xi, choice / max(r.choose_specular, lit(1e-6)));
        s.wi = select(both(specular, r.refracts), k_normalize3(through.wi), s.wi);
    }
    s.exact = s.alone = both(specular, r.mirror);
    // Weigh by all terms, or by the mirror or interface alone
    const Reflection at = reflect_below(r, s.wi);
    s.pdf = at.pdf;
    const real inv = select(at.pdf > lit(0.0), lit(1.0) / max(at.pdf, lit(1e-20)), lit(0.0));
    const real3 whole = reflectance_of(r.x.s, k_saturate(r.o.z)) * r.x.energy.gain / max(r.choose_specular, lit(1e-6));
    const real3 of_mirror = whole * bsdf_lobe_mirror_albedo(lobe_of(r, r.lobe));
    const mask seen = k_dot3(r.horizon, s.wi) > lit(0.0);
    s.weight = select(s.exact, select(seen, of_mirror, vec3_all(lit(0.0))), at.value * inv);
    if (r.x.transmission.refracts) {
        const mask alone = both(both(specular, r.refracts), through.alone);
        s.weight = select(alone, through.weight / max(r.choose_specular, lit(1e-6)), s.weight);
        s.pdf = select(alone, through.pdf * r.choose_specular, s.pdf);
        s.alone = either(s.alone, alone);
    }
    return s;
}

// Samples one layer: the coatings from the highest to the lowest, then what lies below them.
BN_STAGE SurfaceBsdfSample sample_coated(const SurfaceBsdf& r, real2 xi, real choice)
{
    mask taken = mask_from_bits(0);
    real3 glossy = r.x.s.n;
    real rest = lit(1.0), passed = lit(1.0); // probability and transmittance of the layers below
    for (int k = kCoatings - 1; k >= 0; --k) {
        if (!has_coating(r, k))
            continue;
        // Take the coating's direction in lanes that choose it
        const mask chosen = both(not_(taken), choice < r.choose_coating[k]);
        glossy = select(chosen, k_normalize3(bsdf_lobe_sample(coating_lobe_of(r, k), xi).wi), glossy);
        taken = either(taken, chosen);
        // Stretch the rest of the choices
        const real left = lit(1.0) - r.choose_coating[k];
        choice = min(max((choice - r.choose_coating[k]) / left, lit(0.0)), lit(0.99999994));
        rest = rest * left, passed = passed * (lit(1.0) - r.coats[k].share);
    }
    // Weigh by all layers, or by the mirror or interface alone
    SurfaceBsdfSample s = sample_below(r, xi, choice);
    s.wi = select(taken, glossy, s.wi);
    s.exact = both(s.exact, not_(taken)), s.alone = both(s.alone, not_(taken));
    const Reflection at = reflect(r, s.wi);
    const real inv = select(at.pdf > lit(0.0), lit(1.0) / max(at.pdf, lit(1e-20)), lit(0.0));
    s.weight = select(s.alone, s.weight * (passed / rest), at.value * inv);
    s.pdf = select(s.alone, s.pdf * rest, at.pdf);
    return s;
}

BN_INLINE SurfaceBsdfSample sample_surface_bsdf(const SurfaceBsdf& r, real2 xi, real choice)
{
    return r.coatings != 0 ? sample_coated(r, xi, choice) : sample_below(r, xi, choice);
}

} // namespace BN_ISA_NS
} // namespace burnish
