// A surface ready to reflect: the BRDF that the technique `mc` samples, one term for the lobe (placed_lobe.k.h, Schlick's Fresnel) and one
// for the diffuse rest, as values, densities and samples. Directions are world space, unit.
#pragma once
#include "raster/reference/samples.h"
#include "shading/kernels/fresnel.k.h"
#include "shading/models/lambert.k.h"
#include "shading/surface/shaded_point.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct Reflector {
    shaded_point x;
    ggx_aniso_params ggx; // of a lobe that is not tilted
    real3 o;              // to the eye, in the lobe's frame
    real3 horizon;        // normal of the surface, whatever a normal map or a tilt says: the lobe reflects nothing below its horizon
    bool tilted;
    real3 diffuse;        // BRDF of the diffuse part, 1/sr
    real choose_specular; // probability
    mask mirror;          // the lobe has no width: only samples meet it
};

BN_INLINE real luminance_of(real3 c)
{
    return c.x * lit(0.2126) + c.y * lit(0.7152) + c.z * lit(0.0722);
}

BN_INLINE Reflector make_reflector(const ShadingFrame& f, const shaded_point& x)
{
    Reflector r;
    const surface& s = x.s;
    r.x = x, r.tilted = f.tilted != 0;
    r.horizon = x.turned ? x.surface_axes.n : s.n;
    const placed_lobe level = placed_lobe_of(false, x.lobe, s.n, s.v, x.surface_axes);
    r.ggx = level.ggx, r.o = level.o;
    const real passed = passed_to_diffuse(f, x);
    r.diffuse = s.diffuse * (passed * lit(0.31830988618379067));
    r.mirror = x.lobe.sigma_u + x.lobe.sigma_v <= lit(1e-6);
    const real specular = luminance_of((s.f0 * x.dfg.scale + s.f90 * x.dfg.bias) * x.gain);
    const real rest = luminance_of(s.diffuse) * passed;
    const real share = specular / max(specular + rest, lit(1e-20));
    r.choose_specular = select(rest > lit(1e-6), select(specular > lit(1e-6), min(max(share, lit(0.1)), lit(0.9)), lit(0.0)), lit(1.0));
    return r;
}

BN_INLINE placed_lobe tilted_lobe(const Reflector& r)
{
    return placed_lobe_of(true, r.x.lobe, r.x.s.n, r.x.s.v, r.x.surface_axes);
}

BN_INLINE placed_lobe level_lobe(const Reflector& r)
{
    placed_lobe a;
    a.tilted = false;
    a.axes = {r.x.s.n, r.x.lobe.u_axis, r.x.lobe.v_axis};
    a.ggx = r.ggx, a.o = r.o;
    return a;
}

struct LobeValue {
    real value, pdf, o_dot_h; // value: without Fresnel, times the cosine
};

BN_INLINE LobeValue value_of(const placed_lobe& a, real3 wi)
{
    return {placed_lobe_value(a, wi), placed_lobe_pdf(a, wi), placed_lobe_o_dot_h(a, wi)};
}

BN_STAGE LobeValue tilted_lobe_value(const Reflector& r, real3 wi)
{
    return value_of(tilted_lobe(r), wi);
}

BN_STAGE real3 tilted_lobe_sample(const Reflector& r, real2 xi)
{
    return placed_lobe_sample(tilted_lobe(r), xi).wi;
}

struct Reflection {
    real3 value; // BRDF times the cosine, 1/sr
    real pdf;    // of sample_reflector(), 1/sr
};

// A mirror's own reflection is not in it.
BN_INLINE Reflection reflect(const Reflector& r, real3 wi)
{
    const LobeValue l = r.tilted ? tilted_lobe_value(r, wi) : value_of(level_lobe(r), wi);
    const mask shines = both(not_(r.mirror), k_dot3(r.horizon, wi) > lit(0.0));
    const real lobe = select(shines, l.value, lit(0.0));
    const real3 fresnel = fresnel_schlick(r.x.s.f0, r.x.s.f90, k_saturate(l.o_dot_h));
    const real cosine = max(k_dot3(r.x.s.n, wi), lit(0.0));
    Reflection to;
    to.value = fresnel * r.x.gain * lobe + r.diffuse * cosine;
    const real specular_pdf = select(r.mirror, lit(0.0), l.pdf);
    to.pdf = r.choose_specular * specular_pdf + (lit(1.0) - r.choose_specular) * cosine * lit(0.31830988618379067);
    return to;
}

struct ReflectorSample {
    real3 wi;
    real3 weight; // value / pdf, 0 where the sample is none
    real pdf;     // 1/sr; meaningless where it is exact
    mask exact;   // the direction of a mirror, which nothing else finds
};

BN_INLINE ReflectorSample sample_reflector(const Reflector& r, real2 xi, real choice)
{
    const mask specular = choice < r.choose_specular;
    const real3 mirrored = from_lobe(r.x.lobe, r.x.s.n, mirror_direction(r.o, vec3_of(lit(0.0), lit(0.0), lit(1.0))));
    const real3 shiny = r.tilted ? tilted_lobe_sample(r, xi) : placed_lobe_sample(level_lobe(r), xi).wi;
    const real3 dull = from_lobe(r.x.lobe, r.x.s.n, lambert_sample(r.o, xi).wi);
    ReflectorSample s;
    s.wi = k_normalize3(select(specular, select(r.mirror, mirrored, shiny), dull));
    s.exact = both(specular, r.mirror);
    const Reflection at = reflect(r, s.wi);
    s.pdf = at.pdf;
    const real inv = select(at.pdf > lit(0.0), lit(1.0) / max(at.pdf, lit(1e-20)), lit(0.0));
    real3 of_mirror = fresnel_schlick(r.x.s.f0, r.x.s.f90, k_saturate(r.o.z)) * r.x.gain / max(r.choose_specular, lit(1e-6));
    if (r.tilted)
        of_mirror = of_mirror * placed_lobe_mirror_albedo(tilted_lobe(r)); // what masking leaves of it
    const mask seen = k_dot3(r.horizon, s.wi) > lit(0.0);
    s.weight = select(s.exact, select(seen, of_mirror, vec3_all(lit(0.0))), at.value * inv);
    return s;
}

} // namespace BN_ISA_NS
} // namespace burnish
