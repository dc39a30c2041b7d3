// Reflectance of microfacets by angle: Schlick's approximation, or Fresnel's equations for the parts that a frame wants
// exact (FrameDesc::fresnel). A glTF material mixes a metal and a dielectric; each part has its own reflectance.
#ifndef BN_REFLECTANCE_T_H
#define BN_REFLECTANCE_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/fresnel.k.h"
#include "shading/kernels/thin_film.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/material_inputs.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Makes the parts of a surface by Fresnel's equations. A metal without an index keeps Schlick's approximation.
BN_FN fresnel_parts fresnel_parts_of(frame_ref f, material_ref m, BN_IN(material_inputs) at)
{
    fresnel_parts p;
    real3 base = at.base;
    real metallic = at.metallic;
    // Describe the dielectric part
    real one = lit(1.0);
    p.dielectric = one - metallic;
    p.dielectric_f0 = at.dielectric_f0;
    p.dielectric_f90 = at.dielectric_f90;
    p.ior = splat(the_material(m).ior);
    // Describe the metal by base colour
    p.conductor = lit(0.0);
    p.eta = splat3(the_material(m).conductor_eta);
    p.k = splat3(the_material(m).conductor_k);
    p.rest_f0 = base * metallic;
    p.rest_f90 = vec3_all(metallic);
    // Replace the metal by a conductor where the material has an index
    if (the_frame(f).fresnel == kFresnelConductor && the_material(m).conductor != 0) {
        p.conductor = metallic;
        p.rest_f0 = vec3_all(lit(0.0));
        p.rest_f90 = p.rest_f0;
    }
    // Put a film over it
    p.film = at.film;
    p.film_thickness = at.film_thickness;
    p.film_ior = splat(the_material(m).iridescence_ior);
    p.film_side = lit(1.0);
    p.metal = metallic;
    p.metal_f0 = base;
    return p;
}

// Returns a dielectric's reflectance: exact for the index from KHR_materials_ior. KHR_materials_specular moves both ends,
// f0 and f90, as with Schlick's approximation; between them the curve follows the exact one.
BN_FN real3 dielectric_reflectance(real3 f0, real f90, real ior, real v_dot_h)
{
    real eta = min(ior, lit(1e3));
    real side = lit(1.0) + eta;
    real rise = (fresnel_dielectric(v_dot_h, eta) - fresnel_f0(eta)) * (side * side) / max(lit(4.0) * eta, lit(1e-6));
    return f0 + (vec3_all(f90) - f0) * rise;
}

// Returns the reflectance of a film over the dielectric. From inside, light meets both interfaces in the other order, at
// the angle that it has outside; beyond total reflection that is the grazing one.
BN_FN real3 film_on_dielectric(BN_IN(fresnel_parts) p, real v_dot_h)
{
    real sine2 = (lit(1.0) - v_dot_h) * (lit(1.0) + v_dot_h) / max(p.film_side * p.film_side, lit(1e-6));
    real outside = select(p.film_side < lit(1.0), sqrt(max(lit(1.0) - sine2, lit(0.0))), v_dot_h);
    real3 f0 = p.dielectric_f0 / max(p.dielectric_f90, lit(1e-4));
    return thin_film_reflectance(outside, p.film_ior, p.film_thickness, f0) * p.dielectric_f90;
}

// Returns f0 of the Schlick approximation that meets a reflectance at the eye's angle.
BN_FN real3 schlick_f0_of(real3 seen, real3 f90, real n_dot_v)
{
    real away = lit(1.0) - n_dot_v;
    real away2 = away * away;
    real power = away2 * away2 * away;
    real3 rest = (seen - f90 * power) / max(lit(1.0) - power, lit(0.1));
    return clamp(rest, vec3_all(lit(0.0)), vec3_all(lit(1.0)));
}

// Returns a dielectric's reflectance under its film. bare: without the film.
BN_STAGE real3 filmed_dielectric(fresnel_parts p, real3 bare, real v_dot_h)
{
    return bare + (film_on_dielectric(p, v_dot_h) - bare) * p.film;
}

// Returns the reflectance of a film over the mixture.
BN_STAGE real3 film_on_mixture(fresnel_parts p, real v_dot_h)
{
    real3 r = vec3_all(lit(0.0));
    if (any_lane(p.metal > lit(0.0)))
        r = r + thin_film_reflectance(v_dot_h, p.film_ior, p.film_thickness, p.metal_f0) * p.metal;
    if (any_lane(p.metal < lit(1.0)))
        r = r + film_on_dielectric(p, v_dot_h) * (lit(1.0) - p.metal);
    return r;
}

// Returns the mixture's reflectance by Fresnel's equations, without its film.
BN_STAGE real3 bare_reflectance(fresnel_parts p, real v_dot_h)
{
    real3 r = fresnel_schlick(p.rest_f0, p.rest_f90, v_dot_h);
    if (any_lane(p.dielectric > lit(0.0)))
        r = r + dielectric_reflectance(p.dielectric_f0, p.dielectric_f90, p.ior, v_dot_h) * p.dielectric;
    if (any_lane(p.conductor > lit(0.0)))
        r = r + fresnel_conductor3(v_dot_h, p.eta, p.k) * p.conductor;
    return r;
}

// Returns the mixture's reflectance by Fresnel's equations.
BN_FN real3 exact_reflectance(BN_IN(fresnel_parts) p, real v_dot_h)
{
    real3 r = bare_reflectance(p, v_dot_h);
    if (film_used() && any_lane(p.film > lit(0.0)))
        r = r + (film_on_mixture(p, v_dot_h) - r) * p.film;
    return r;
}

// Returns the surface's reflectance. v_dot_h: cosine between eye and half vector, [0,1].
BN_FN real3 reflectance_of(BN_IN(surface) s, real v_dot_h)
{
    if (s.exact == 0)
        return BN_MUTANT(no_fresnel, fresnel_schlick(s.f0, s.f90, v_dot_h), s.f0);
    return exact_reflectance(s.parts, v_dot_h);
}

// Returns the cosine at which Schlick's approximation equals its mean over the lobe: its fifth power there is the albedo's
// share of f90. A split integral evaluates exact reflectances at this cosine. So they are exact for mirrors, and for all
// lobes where the curve has Schlick's shape.
BN_FN real mean_v_dot_h(dfg_value dfg)
{
    real power = max(dfg.bias, lit(0.0)) / max(dfg.scale + dfg.bias, lit(1e-4));
    real root = k_exp2(k_log2(max(power, lit(1e-30))) * lit(0.2));
    return k_saturate(lit(1.0) - root);
}

// Cosines between eye and microfacets for which a film's reflectance has its mean over a GGX lobe: the mean cosine less and plus its
// deviation.
struct film_cosines {
    real lower, upper;
};

// Fits moments of cosines over the lobe's reflected light: mean within .009, deviation within .022. roughness: perceptual.
BN_FN film_cosines film_cosines_of(real n_dot_v, real roughness)
{
    real r = roughness;
    real r2 = r * r;
    real c = n_dot_v;
    real c2 = c * c;
    // Fit the mean
    real x = c / (c + r2);
    real m0 = lit(4.1271) + x * (x * (lit(3.9294) - lit(3.3840) * x) - lit(4.1565));
    real m1 = x * (lit(5.5774) - lit(3.6190) * x) - lit(6.2474);
    real m2 = lit(3.1117) - lit(2.2721) * x;
    real mean = c + r2 * (m0 + r * (m1 + r * (m2 - lit(0.3208) * r)));
    // Fit the deviation
    real d0 = lit(0.0908) + c * (c * (lit(0.4951) * c - lit(0.1751)) - lit(0.2955));
    real d1 = lit(0.9217) + c * (lit(0.3955) - lit(0.1214) * c);
    real d2 = lit(-1.3225) - lit(0.0980) * c;
    real spread = r2 * (lit(1.02) - lit(0.9) * c2) / (lit(0.05) + r2);
    real deviation = max(spread * (d0 + r * (d1 + r * (d2 + lit(0.5340) * r))), lit(0.0));
    film_cosines k;
    k.lower = k_saturate(mean - deviation);
    k.upper = k_saturate(mean + deviation);
    return k;
}

// Returns the film's directional albedo over the lobe. Takes values, since a surface that is passed on leaves registers.
BN_STAGE real3 film_albedo(fresnel_parts p, real n_dot_v, real roughness, dfg_value dfg)
{
    film_cosines k = film_cosines_of(n_dot_v, roughness);
    return (film_on_mixture(p, k.lower) + film_on_mixture(p, k.upper)) * (lit(0.5) * (dfg.scale + dfg.bias));
}

// Returns the same over the dielectric part alone.
BN_STAGE real3 film_albedo_on_dielectric(fresnel_parts p, real n_dot_v, real roughness, dfg_value dfg)
{
    film_cosines k = film_cosines_of(n_dot_v, roughness);
    return (film_on_dielectric(p, k.lower) + film_on_dielectric(p, k.upper)) * (lit(0.5) * (dfg.scale + dfg.bias));
}

// Returns the specular lobe's directional albedo.
BN_FN real3 albedo_of(BN_IN(surface) s, dfg_value dfg)
{
    if (s.exact == 0)
        return BN_MUTANT(no_fresnel, s.f0 * dfg.scale + s.f90 * dfg.bias, s.f0 * (dfg.scale + dfg.bias));
    // Take exact reflectances at the mean angle
    real3 bare = s.parts.rest_f0 * dfg.scale + s.parts.rest_f90 * dfg.bias;
    if (s.exact != kFilmReflects)
        bare = bare_reflectance(s.parts, mean_v_dot_h(dfg)) * (dfg.scale + dfg.bias);
    if (film_used() && s.exact >= kFilmReflects)
        bare = bare + (film_albedo(s.parts, s.n_dot_v, s.roughness, dfg) - bare) * s.parts.film;
    return bare;
}

// Returns the dielectric part's albedo, as if it were the whole surface.
BN_FN real3 dielectric_albedo_of(BN_IN(surface) s, real3 f0, real f90, dfg_value dfg)
{
    real bias = f90 * dfg.bias;
    real3 schlick = f0 * dfg.scale + vec3_all(bias);
    if (s.exact == 0)
        return schlick;
    // Take exact reflectances at the mean angle
    real3 r = schlick;
    if (s.exact != kFilmReflects)
        r = dielectric_reflectance(f0, f90, s.parts.ior, mean_v_dot_h(dfg)) * (dfg.scale + dfg.bias);
    if (film_used() && s.exact >= kFilmReflects)
        r = r + (film_albedo_on_dielectric(s.parts, s.n_dot_v, s.roughness, dfg) - r) * s.parts.film;
    return r;
}

BN_KERNELS_END

#endif
