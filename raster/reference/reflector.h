// A surface ready to reflect: the BRDF that the technique `mc` samples, one term for the lobe (anisotropic GGX, height-correlated Smith,
// Schlick's Fresnel; an ellipsoid's where lobes are tilted) and one for the diffuse rest, as values, densities and samples. Directions
// are world space, unit.
#pragma once
#include "raster/frame/lanes_records.h"
#include "raster/reference/samples.h"
#include "shading/kernels/dfg.k.h"
#include "shading/kernels/ellipsoid.k.h"
#include "shading/kernels/energy.k.h"
#include "shading/kernels/fresnel.k.h"
#include "shading/kernels/ggx_aniso.k.h"
#include "shading/kernels/lambert.k.h"
#include "shading/kernels/lobe.k.h"
#include "shading/kernels/surface.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct Reflector {
    surface s;
    aniso_lobe lobe;
    ggx_aniso_params ggx;
    real3 o;              // to the eye, in the lobe's frame
    surface_frame own;    // of the surface, whatever a normal map or a tilt says: the lobe reflects nothing below its horizon
    bool tilted;          // then the lobe is an ellipsoid's, whose masking knows the surface
    real3 gain;           // of the lobe
    real3 diffuse;        // BRDF of the diffuse part, 1/sr
    real choose_specular; // probability
    mask mirror;          // the lobe has no width: only samples meet it
};

BN_INLINE real luminance_of(real3 c) { return c.x * lit(0.2126) + c.y * lit(0.7152) + c.z * lit(0.0722); }

// The lobe as an ellipsoid in the surface's own frame.
struct TiltedLobe {
    ellipsoid_params p;
    real3 o;
};

BN_INLINE real3 to_own(const Reflector& r, real3 w) { return vec3_of(k_dot3(r.own.t, w), k_dot3(r.own.b, w), k_dot3(r.own.n, w)); }

BN_INLINE TiltedLobe tilted_lobe(const Reflector& r)
{
    TiltedLobe t;
    t.p = ellipsoid_params_of_rows(r.ggx.alpha_x, r.ggx.alpha_y, to_own(r, r.lobe.u_axis), to_own(r, r.lobe.v_axis), to_own(r, r.s.n));
    t.o = to_own(r, r.s.v);
    t.o.z = max(t.o.z, lit(1e-4));
    t.o = k_normalize3(t.o);
    return t;
}

BN_INLINE Reflector make_reflector(const surface& s, const aniso_lobe& lobe, const surface_frame& own, bool tilted, const dfg_value& dfg,
                                   bool compensate, real3 dielectric_f0, real dielectric_f90)
{
    Reflector r;
    r.s = s, r.lobe = lobe, r.own = own, r.tilted = tilted;
    const real root2 = lit(1.4142135623730951);
    r.ggx = ggx_aniso_params_of(lobe.sigma_u * root2, lobe.sigma_v * root2);
    r.o = to_lobe(lobe, s.n, s.v);
    r.o.z = max(r.o.z, lit(1e-4));
    r.o = k_normalize3(r.o);
    const real3 one = vec3_all(lit(1.0));
    r.gain = compensate ? energy_compensation(s.f0, dfg) : one;
    if (compensate && tilted) {
        const TiltedLobe t = tilted_lobe(r);
        r.gain = energy_compensation_of_albedo(s.f0, min(ellipsoid_albedo(t.p, t.o), lit(1.0)));
    }
    const real3 dielectric = (dielectric_f0 * dfg.scale + vec3_all(dielectric_f90 * dfg.bias)) *
                             (compensate ? energy_compensation(dielectric_f0, dfg) : one);
    const real passed = lit(1.0) - max(dielectric.x, max(dielectric.y, dielectric.z));
    r.diffuse = s.diffuse * (passed * lit(0.31830988618379067));
    r.mirror = lobe.sigma_u + lobe.sigma_v <= lit(1e-6);
    const real specular = luminance_of((s.f0 * dfg.scale + s.f90 * dfg.bias) * r.gain);
    const real rest = luminance_of(s.diffuse) * passed;
    const real share = specular / max(specular + rest, lit(1e-20));
    r.choose_specular = select(rest > lit(1e-6), select(specular > lit(1e-6), min(max(share, lit(0.1)), lit(0.9)), lit(0.0)), lit(1.0));
    return r;
}

struct LobeValue {
    real value, pdf, o_dot_h; // value: without Fresnel, times the cosine
};

BN_INLINE LobeValue level_lobe(const Reflector& r, real3 i)
{
    const real3 h = half_vector(r.o, i);
    const real d = ggx_aniso_d(r.ggx, h);
    LobeValue l;
    l.value = d * ggx_aniso_visibility(r.ggx, r.o, i) * max(i.z, lit(0.0));
    l.pdf = lit(0.5) * d / max(r.o.z + ggx_aniso_stretch(r.ggx, r.o), lit(1e-20));
    l.o_dot_h = k_dot3(r.o, h);
    const mask above = i.z > lit(0.0);
    l.value = select(above, l.value, lit(0.0));
    l.pdf = select(above, l.pdf, lit(0.0));
    return l;
}

BN_STAGE LobeValue tilted_lobe_value(const Reflector& r, real3 wi)
{
    const TiltedLobe t = tilted_lobe(r);
    const real3 i = to_own(r, wi);
    LobeValue l;
    l.value = ellipsoid_eval(t.p, t.o, i) * max(i.z, lit(0.0));
    l.pdf = ellipsoid_pdf(t.p, t.o, i);
    l.o_dot_h = k_dot3(t.o, half_vector(t.o, i));
    return l;
}

BN_STAGE real3 tilted_lobe_sample(const Reflector& r, real2 xi)
{
    const TiltedLobe t = tilted_lobe(r);
    const real3 wi = ellipsoid_sample(t.p, t.o, xi).wi;
    return r.own.t * wi.x + r.own.b * wi.y + r.own.n * wi.z;
}

struct Reflection {
    real3 value; // BRDF times the cosine, 1/sr
    real pdf;    // of sample_reflector(), 1/sr
};

// A mirror's own reflection is not in it.
BN_INLINE Reflection reflect(const Reflector& r, real3 wi)
{
    const real3 i = to_lobe(r.lobe, r.s.n, wi);
    const LobeValue l = r.tilted ? tilted_lobe_value(r, wi) : level_lobe(r, i);
    const mask shines = both(not_(r.mirror), k_dot3(r.own.n, wi) > lit(0.0));
    const real lobe = select(shines, l.value, lit(0.0));
    const real3 fresnel = fresnel_schlick(r.s.f0, r.s.f90, k_saturate(l.o_dot_h));
    const real cosine = max(i.z, lit(0.0));
    Reflection to;
    to.value = fresnel * r.gain * lobe + r.diffuse * cosine;
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
    const real3 mirror_axis = vec3_of(lit(0.0), lit(0.0), lit(1.0));
    real3 h = mirror_axis;
    if (!r.tilted)
        h = ggx_aniso_visible_normal(r.ggx, r.o, xi);
    const real3 shiny = mirror_direction(r.o, select(r.mirror, mirror_axis, h));
    const bsdf_sample dull = lambert_sample(r.o, xi);
    ReflectorSample s;
    const real3 local = select(specular, shiny, dull.wi);
    s.wi = from_lobe(r.lobe, r.s.n, local);
    if (r.tilted)
        s.wi = select(both(specular, not_(r.mirror)), tilted_lobe_sample(r, xi), s.wi);
    s.wi = k_normalize3(s.wi);
    s.exact = both(specular, r.mirror);
    const Reflection at = reflect(r, s.wi);
    s.pdf = at.pdf;
    const real inv = select(at.pdf > lit(0.0), lit(1.0) / max(at.pdf, lit(1e-20)), lit(0.0));
    real3 mirrored = fresnel_schlick(r.s.f0, r.s.f90, k_saturate(r.o.z)) * r.gain / max(r.choose_specular, lit(1e-6));
    if (r.tilted) {
        const TiltedLobe t = tilted_lobe(r);
        mirrored = mirrored * ellipsoid_mirror_albedo(t.p, t.o); // what masking leaves of it
    }
    const mask seen = k_dot3(r.own.n, s.wi) > lit(0.0);
    s.weight = select(s.exact, select(seen, mirrored, vec3_all(lit(0.0))), at.value * inv);
    return s;
}

} // namespace BN_ISA_NS
} // namespace burnish
