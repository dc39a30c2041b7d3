// A specular lobe on a surface: the contract of shading/models (value, density, sample, albedo) over world-space
// directions, all without Fresnel. shading/models.def lists the models that can lie on a surface, and how (BN_LOBE). A lobe
// with zero width is a mirror, which values do not handle.
#ifndef BN_BSDF_LOBE_T_H
#define BN_BSDF_LOBE_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"
#define BN_LOBE_TEXTS
#include "shading/models.def"

BN_KERNELS_BEGIN

struct bsdf_lobe {
    int model;             // uniform: index among the lobes of shading/models.def
    surface_frame axes;    // frame of its directions: the lobe's own, or the surface's for a lobe that lies in the surface
    real alpha_u, alpha_v; // widths
    real3 u, v, n;         // the lobe's axes in that frame; only for a lobe that lies in the surface
    real3 o;               // to the eye, above the horizon
#define BN_LOBE(id, at, type, lies, normals, traits, made_of) type id; // only the model's own member is set
#include "shading/models.def"
};

// Transform between world space and a frame (t, b, n).
BN_FN real3 to_frame(surface_frame g, real3 w)
{
    return vec3_of(k_dot3(g.t, w), k_dot3(g.b, w), k_dot3(g.n, w));
}
BN_FN real3 from_frame(surface_frame g, real3 w)
{
    return g.t * w.x + g.b * w.y + g.n * w.z;
}

// Returns a model's traits, by its line in models.def.
BN_FN int traits_of_model(int model)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (model == at)                                                                                                                       \
        return (traits) + kLies_##lies + kNormals_##normals;
#include "shading/models.def"
    return 0;
}

// Returns true where a model has the trait.
BN_FN bool lobe_has(int model, int trait)
{
    return (traits_of_model(model) & trait) != 0;
}

// Returns the index of the lobe with the trait.
BN_FN int lobe_that_has(int trait)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (((traits)&trait) != 0)                                                                                                             \
        return at;
#include "shading/models.def"
    return 0;
}

// Returns the lobe with its model's parameters filled in.
BN_FN bsdf_lobe with_params(bsdf_lobe lobe)
{
    bsdf_lobe a = lobe;
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (a.model == at)                                                                                                                     \
        a.id = made_of;
#include "shading/models.def"
    return a;
}

// Places a lobe. n: the lobe's normal, v: to the eye, unit, world space; axes: the geometry's.
BN_FN bsdf_lobe make_bsdf_lobe(int model, aniso_lobe lobe, real3 n, real3 v, surface_frame axes)
{
    // Convert slope deviations to widths
    real root2 = lit(1.4142135623730951);
    bsdf_lobe r;
    r.model = model;
    r.alpha_u = lobe.sigma_u * root2;
    r.alpha_v = lobe.sigma_v * root2;
    r.axes = axes;
    // Use the mean width for round lobes
    if (lobe_has(model, kLies_round)) {
        real roughness = lobe_roughness(lobe);
        r.alpha_u = roughness * roughness;
        r.alpha_v = r.alpha_u;
    }
    // Choose the frame: the surface's or the lobe's own
    if (lobe_has(model, kLies_surface)) {
        r.u = to_frame(axes, lobe.u_axis);
        r.v = to_frame(axes, lobe.v_axis);
        r.n = to_frame(axes, n);
    } else {
        bool threads = lobe_has(model, kLies_thread);
        r.axes.n = n;
        r.axes.t = threads ? lobe.v_axis : lobe.u_axis;
        r.axes.b = threads ? lobe.u_axis : lobe.v_axis;
    }
    // Lift the eye above the horizon
    r.o = to_frame(r.axes, v);
    r.o.z = max(r.o.z, lit(1e-4));
    r.o = k_normalize3(r.o);
    return with_params(r);
}

// Returns the BRDF, 1/sr. i: unit, in the lobe's frame.
BN_FN real bsdf_lobe_eval(bsdf_lobe a, real3 i)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at)                                                                                                    \
        return id##_eval(a.id, a.o, i);
#include "shading/models.def"
    return lit(0.0);
}

// Returns BRDF times the cosine of wi, 1/sr. wi: unit.
BN_FN real bsdf_lobe_eval_cos(bsdf_lobe a, real3 wi)
{
    real3 i = to_frame(a.axes, wi);
    real cosine = max(i.z, lit(0.0));
    if (lobe_has(a.model, kLies_thread)) // its eval includes the cosine
        return bsdf_lobe_eval(a, i);
    return bsdf_lobe_eval(a, i) * cosine;
}

// Returns the density of bsdf_lobe_sample(), 1/sr.
BN_FN real bsdf_lobe_pdf(bsdf_lobe a, real3 wi)
{
    real3 i = to_frame(a.axes, wi);
#define BN_PDF_round(id, p) id##_pdf(p, a.o, i)
#define BN_PDF_level(id, p) id##_pdf(p, a.o, i)
#define BN_PDF_surface(id, p) id##_pdf(p, a.o, i)
#define BN_PDF_thread(id, p) id##_pdf(a.o, i)
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at)                                                                                                    \
        return BN_PDF_##lies(id, a.id);
#include "shading/models.def"
    return lit(0.0);
}

// Returns the cosine between view and half vector, for Fresnel.
BN_FN real bsdf_lobe_o_dot_h(bsdf_lobe a, real3 wi)
{
    return k_dot3(a.o, half_vector(a.o, to_frame(a.axes, wi)));
}

// Samples the lobe, xi in [0,1)^2. Returns the model's sample with wi in world space.
BN_FN bsdf_sample bsdf_lobe_sample(bsdf_lobe a, real2 xi)
{
    bsdf_sample b = bsdf_sample_of(a.o, lit(0.0), lit(0.0), lit(0.0), lit(0.0) > lit(0.0));
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at)                                                                                                    \
        b = id##_sample(a.id, a.o, xi);
#include "shading/models.def"
    b.wi = from_frame(a.axes, b.wi);
    return b;
}

// Directional albedo without absorption, from the lobe's own samples.
struct lobe_energy {
    real albedo;
    real grazing; // the part that Schlick's factor weights by f90 alone, whatever f0 is
};

// Computes albedo on a Fibonacci lattice. count, before: a Fibonacci number and its predecessor.
BN_STAGE lobe_energy bsdf_lobe_energy(BN_IN(bsdf_lobe) a, int count, int before)
{
    real part = lit(1.0) / to_real(int_lit(count));
    lobe_energy sum;
    sum.albedo = lit(0.0);
    sum.grazing = lit(0.0);
    for (int i = 0; i < count; ++i) {
        // Sample the lobe
        real x = (to_real(int_lit(i)) + lit(0.5)) * part;
        real y = (to_real(int_lit(i * before % count)) + lit(0.5)) * part;
        bsdf_sample s = bsdf_lobe_sample(a, vec2_of(x, y));
        // Add the weight, and the part at grazing angles
        real m = lit(1.0) - min(s.o_dot_h, lit(1.0));
        real m2 = m * m;
        sum.albedo = sum.albedo + s.weight;
        sum.grazing = sum.grazing + s.weight * (m2 * m2 * m);
    }
    sum.albedo = sum.albedo * part;
    sum.grazing = sum.grazing * part;
    return sum;
}

BN_FN real bsdf_lobe_albedo(BN_IN(bsdf_lobe) a, int count, int before)
{
    return bsdf_lobe_energy(a, count, before).albedo;
}

// Computes albedo with 21 samples, or with 89 for the Ashikhmin-Shirley lobe, which ends at the horizon. Tables replace
// this for the default lobes (see directional_albedo()) and for Ashikhmin-Shirley lobes with constant widths.
BN_FN lobe_energy bsdf_lobe_own_energy(BN_IN(bsdf_lobe) a)
{
    if (lobe_has(a.model, kPhongLobe))
        return bsdf_lobe_energy(a, 89, 55);
    return bsdf_lobe_energy(a, 21, 13);
}

// Returns BRDF times cosine over the density of normals, for a model with GGX normals. The density is GGX's about the
// lobe's own normal. i: unit, in the lobe's frame.
BN_FN real bsdf_lobe_masking(bsdf_lobe a, real3 i)
{
    real3 risen = vec3_of(i.x, i.y, max(i.z, lit(0.0)));
#define BN_MASKING_ggx(id, p) return id##_masking(p, a.o, risen);
#define BN_MASKING_own(id, p)
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at) {                                                                                                  \
        BN_MASKING_##normals(id, a.id)                                                                                                     \
    }
#include "shading/models.def"
    return lit(0.0);
}

// Returns the albedo that masking leaves in the mirror limit.
BN_FN real bsdf_lobe_mirror_albedo(bsdf_lobe a)
{
#define BN_MIRRORED_round(id, p)
#define BN_MIRRORED_level(id, p)
#define BN_MIRRORED_thread(id, p)
#define BN_MIRRORED_surface(id, p) return id##_mirror_albedo(p, a.o);
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at) {                                                                                                  \
        BN_MIRRORED_##lies(id, a.id)                                                                                                       \
    }
#include "shading/models.def"
    return lit(1.0);
}

// Places a lobe for the lights of surface s, in the frame of the surface's cosines. Eye and light may lie lower there than
// a lobe's sample. A round lobe lies about s.n, with s.roughness, and needs no axes.
BN_FN bsdf_lobe bsdf_lobe_under_lights(int model, aniso_lobe lobe, surface s, surface_frame axes)
{
    // Place the lobe as for samples
    bsdf_lobe r = make_bsdf_lobe(model, lobe, s.n, s.v, axes);
    if (lobe_has(model, kLies_surface))
        return r;
    // Keep the eye and the roughness that the surface's cosines use
    r.o = to_frame(r.axes, s.v);
    r.o.z = s.n_dot_v;
    if (lobe_has(model, kLies_round)) {
        r.alpha_u = s.roughness * s.roughness;
        r.alpha_v = r.alpha_u;
    }
    return with_params(r);
}

// Returns the BRDF of such an untilted lobe for a light above its horizon, 1/sr. l: unit, world space.
BN_FN real bsdf_lobe_light(bsdf_lobe a, surface s, real3 l)
{
    real3 i = to_frame(a.axes, l);
    i.z = max(i.z, lit(1e-4));
#define BN_LIGHT_round(id, p) return id##_eval_about(p, s.n, s.v, s.n_dot_v, l);
#define BN_LIGHT_level(id, p) return id##_eval(p, a.o, i);
#define BN_LIGHT_thread(id, p) // see bsdf_lobe_eval_cos()
#define BN_LIGHT_surface(id, p)
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at) {                                                                                                  \
        BN_LIGHT_##lies(id, a.id)                                                                                                          \
    }
#include "shading/models.def"
    return lit(0.0);
}

BN_KERNELS_END

#endif
