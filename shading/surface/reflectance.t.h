// Reflectance of microfacets by angle: Schlick's approximation, or Fresnel's equations for the parts that a frame wants
// exact (FrameDesc::fresnel). A glTF material mixes a metal and a dielectric; each part has its own reflectance.
#ifndef BN_REFLECTANCE_T_H
#define BN_REFLECTANCE_T_H

#include "shading/kernels/fresnel.k.h"
#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Makes the parts for a frame with exact reflectances. base, metallic: as in glTF, linear, [0,1]. A metal without an index
// keeps Schlick's approximation.
BN_FN fresnel_parts fresnel_parts_of(frame_ref f, material_ref m, real3 base, real metallic, real3 dielectric_f0, real dielectric_f90)
{
    fresnel_parts p;
    // Describe the dielectric part
    real one = lit(1.0);
    p.dielectric = one - metallic;
    p.dielectric_f0 = dielectric_f0;
    p.dielectric_f90 = dielectric_f90;
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

// Returns the mixture's reflectance by Fresnel's equations.
BN_STAGE real3 exact_reflectance(fresnel_parts p, real v_dot_h)
{
    real3 r = fresnel_schlick(p.rest_f0, p.rest_f90, v_dot_h);
    if (any_lane(p.dielectric > lit(0.0)))
        r = r + dielectric_reflectance(p.dielectric_f0, p.dielectric_f90, p.ior, v_dot_h) * p.dielectric;
    if (any_lane(p.conductor > lit(0.0)))
        r = r + fresnel_conductor3(v_dot_h, p.eta, p.k) * p.conductor;
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

// Returns the specular lobe's directional albedo.
BN_FN real3 albedo_of(BN_IN(surface) s, dfg_value dfg)
{
    if (s.exact == 0)
        return BN_MUTANT(no_fresnel, s.f0 * dfg.scale + s.f90 * dfg.bias, s.f0 * (dfg.scale + dfg.bias));
    return exact_reflectance(s.parts, mean_v_dot_h(dfg)) * (dfg.scale + dfg.bias);
}

// Returns the dielectric part's albedo, as if it were the whole surface.
BN_FN real3 dielectric_albedo_of(BN_IN(surface) s, real3 f0, real f90, dfg_value dfg)
{
    if (s.exact == 0) {
        real bias = f90 * dfg.bias;
        return f0 * dfg.scale + vec3_all(bias);
    }
    return dielectric_reflectance(f0, f90, s.parts.ior, mean_v_dot_h(dfg)) * (dfg.scale + dfg.bias);
}

BN_KERNELS_END

#endif
