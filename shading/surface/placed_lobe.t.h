// A specular lobe in place, with the contract of the models in shading/models over directions of world space: value, density, sample and
// albedo, all without Fresnel. Which models can lie on a surface, and how, is listed in shading/models.def (BN_LOBE). A lobe of no width is
// a mirror, which values do not meet.
#ifndef BN_PLACED_LOBE_T_H
#define BN_PLACED_LOBE_T_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"
#define BN_LOBE_TEXTS
#include "shading/models.def"

BN_KERNELS_BEGIN

struct placed_lobe {
    int model;             // uniform: its place among the lobes of shading/models.def
    surface_frame axes;    // that its directions are in: the lobe's own or, of one that knows the surface, the surface's
    real alpha_u, alpha_v; // widths
    real3 u, v, n;         // the lobe's axes in that frame; only of one that knows the surface
    real3 o;               // to the eye, above the horizon
#define BN_LOBE(id, at, type, lies, normals, traits, made_of) type id; // of the one that it is
#include "shading/models.def"
};

// Between world space and a frame (t, b, n).
BN_FN real3 to_frame(surface_frame g, real3 w)
{
    return vec3_of(k_dot3(g.t, w), k_dot3(g.b, w), k_dot3(g.n, w));
}
BN_FN real3 from_frame(surface_frame g, real3 w)
{
    return g.t * w.x + g.b * w.y + g.n * w.z;
}

// How a model of the list lies.
BN_FN bool lobe_has(int model, int trait)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (model == at)                                                                                                                       \
        return (((traits) + kLies_##lies + kNormals_##normals) & trait) != 0;
#include "shading/models.def"
    return false;
}

// The place of the lobe that has the trait.
BN_FN int lobe_that_has(int trait)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (((traits)&trait) != 0)                                                                                                             \
        return at;
#include "shading/models.def"
    return 0;
}

BN_FN placed_lobe with_params(placed_lobe lobe)
{
    placed_lobe a = lobe;
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (a.model == at)                                                                                                                     \
        a.id = made_of;
#include "shading/models.def"
    return a;
}

// n: the lobe's normal, v: to the eye, unit, world space; axes: of the geometry.
BN_FN placed_lobe placed_lobe_of(int model, aniso_lobe lobe, real3 n, real3 v, surface_frame axes)
{
    real root2 = lit(1.4142135623730951);
    placed_lobe r;
    r.model = model;
    r.alpha_u = lobe.sigma_u * root2;
    r.alpha_v = lobe.sigma_v * root2;
    r.axes = axes;
    if (lobe_has(model, kLies_round)) {
        real alpha_lin = lobe_alpha_lin(lobe);
        r.alpha_u = alpha_lin * alpha_lin;
        r.alpha_v = r.alpha_u;
    }
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
    r.o = to_frame(r.axes, v);
    r.o.z = max(r.o.z, lit(1e-4));
    r.o = k_normalize3(r.o);
    return with_params(r);
}

// BRDF, 1/sr; i: unit, in the lobe's axes.
BN_FN real placed_lobe_eval(placed_lobe a, real3 i)
{
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at)                                                                                                    \
        return id##_eval(a.id, a.o, i);
#include "shading/models.def"
    return lit(0.0);
}

// BRDF times the cosine of wi, 1/sr; wi unit.
BN_FN real placed_lobe_value(placed_lobe a, real3 wi)
{
    real3 i = to_frame(a.axes, wi);
    real cosine = max(i.z, lit(0.0));
    if (lobe_has(a.model, kLies_thread)) // whose eval is in place of that
        return placed_lobe_eval(a, i);
    return placed_lobe_eval(a, i) * cosine;
}

// Density of placed_lobe_sample(), 1/sr.
BN_FN real placed_lobe_pdf(placed_lobe a, real3 wi)
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

// Cosine between view and half vector, for Fresnel.
BN_FN real placed_lobe_o_dot_h(placed_lobe a, real3 wi)
{
    return k_dot3(a.o, half_vector(a.o, to_frame(a.axes, wi)));
}

// xi in [0,1)^2. Only its wi is not the model's own: it is in world space.
BN_FN bsdf_sample placed_lobe_sample(placed_lobe a, real2 xi)
{
    bsdf_sample b = bsdf_sample_of(a.o, lit(0.0), lit(0.0), lit(0.0), lit(0.0) > lit(0.0));
#define BN_LOBE(id, at, type, lies, normals, traits, made_of)                                                                              \
    if (lobe_used(at) && a.model == at)                                                                                                    \
        b = id##_sample(a.id, a.o, xi);
#include "shading/models.def"
    b.wi = from_frame(a.axes, b.wi);
    return b;
}

// Directional albedo where nothing is absorbed, by the lobe's own samples.
struct lobe_energy {
    real albedo;
    real grazing; // of it, what Schlick's factor takes whatever f0 is: the part of f90 alone
};

// By a Fibonacci lattice. count, before: a Fibonacci number of them and the one before it.
BN_STAGE lobe_energy placed_lobe_energy(BN_IN(placed_lobe) a, int count, int before)
{
    real part = lit(1.0) / to_real(int_lit(count));
    lobe_energy sum;
    sum.albedo = lit(0.0);
    sum.grazing = lit(0.0);
    for (int i = 0; i < count; ++i) {
        real x = (to_real(int_lit(i)) + lit(0.5)) * part;
        real y = (to_real(int_lit(i * before % count)) + lit(0.5)) * part;
        bsdf_sample s = placed_lobe_sample(a, vec2_of(x, y));
        real m = lit(1.0) - min(s.o_dot_h, lit(1.0));
        real m2 = m * m;
        sum.albedo = sum.albedo + s.weight;
        sum.grazing = sum.grazing + s.weight * (m2 * m2 * m);
    }
    sum.albedo = sum.albedo * part;
    sum.grazing = sum.grazing * part;
    return sum;
}

BN_FN real placed_lobe_mean(BN_IN(placed_lobe) a, int count, int before)
{
    return placed_lobe_energy(a, count, before).albedo;
}

// By 21 samples: off by 0.02 rms, by 0.07 at most; of Ashikhmin and Shirley's, which ends at the horizon, by 89: by 0.01 at most. Tables
// have it for the usual lobes (see directional_albedo()), and where widths are the same everywhere for theirs.
BN_FN lobe_energy placed_lobe_own_energy(BN_IN(placed_lobe) a)
{
    if (lobe_has(a.model, kLobeOfPhong))
        return placed_lobe_energy(a, 89, 55);
    return placed_lobe_energy(a, 21, 13);
}

// BRDF times cosine over the density of normals that D would be if it were GGX's about the lobe's own normal, of a model whose normals are
// GGX's; i: unit, in the lobe's axes.
BN_FN real placed_lobe_masking(placed_lobe a, real3 i)
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

// What masking leaves of the lobe as a mirror.
BN_FN real placed_lobe_mirror_albedo(placed_lobe a)
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

// As lights of the surface s meet it: in the frame that the surface's cosines are of, where eye and light may lie lower than a lobe's
// sample does. A round one is about s.n, as wide as s is rough, and needs no axes.
BN_FN placed_lobe placed_lobe_under_lights(int model, aniso_lobe lobe, surface s, surface_frame axes)
{
    placed_lobe r = placed_lobe_of(model, lobe, s.n, s.v, axes);
    if (lobe_has(model, kLies_surface))
        return r;
    r.o = to_frame(r.axes, s.v);
    r.o.z = s.n_dot_v;
    if (lobe_has(model, kLies_round)) {
        r.alpha_u = s.roughness * s.roughness;
        r.alpha_v = r.alpha_u;
    }
    return with_params(r);
}

// BRDF of such a lobe that lies upright, for a light above its horizon, 1/sr. l: unit, world space.
BN_FN real placed_lobe_light(placed_lobe a, surface s, real3 l)
{
    real3 i = to_frame(a.axes, l);
    i.z = max(i.z, lit(1e-4));
#define BN_LIGHT_round(id, p) return id##_eval_about(p, s.n, s.v, s.n_dot_v, l);
#define BN_LIGHT_level(id, p) return id##_eval(p, a.o, i);
#define BN_LIGHT_thread(id, p) // see placed_lobe_value()
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
