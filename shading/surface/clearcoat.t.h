// A clear coat, by KHR_materials_clearcoat: an isotropic GGX lobe about its own normal, with index 1.5 or the material's own. The Fresnel
// factor uses the view cosine. So the coat takes that share of all incoming light, and the layer below, its emission included, has the
// rest: energy is conserved. (glTF 2.0, appendix B, "fresnel_coat".)
#ifndef BN_CLEARCOAT_T_H
#define BN_CLEARCOAT_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/fresnel.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/coating.t.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/material_inputs.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Multiplies the coat's factors by its textures.
BN_FN void clearcoat_inputs(material_ref m, BN_IN(texture_fetches) t, BN_INOUT(material_inputs) r)
{
    r.coat = lit(0.0);
    r.coat_roughness = lit(0.0);
    r.coat_normal_map = vec3_all(lit(0.0));
    if (!has_coating(m, kCoating_clearcoat))
        return;
    r.coat = splat(the_material(m).clearcoat);
    if (texture_used(m, kCoatTex))
        r.coat = r.coat * texel_of(t, kCoatTex).x;
    r.coat_roughness = splat(the_material(m).clearcoat_roughness);
    if (texture_used(m, kCoatRoughnessTex))
        r.coat_roughness = r.coat_roughness * texel_of(t, kCoatRoughnessTex).y;
    if (!texture_used(m, kCoatNormalTex))
        return;
    real4 normal = texel_of(t, kCoatNormalTex);
    r.coat_normal_map = scaled_normal(normal, splat(the_material(m).clearcoat_normal_scale));
    // Widen the lobe by the spread of the normals below the texel
    if (the_material(m).coat_spread != 0) {
        real alpha = r.coat_roughness * r.coat_roughness;
        real wider = sqrt(alpha * alpha + normal.w);
        r.coat_roughness = min(sqrt(wider), lit(1.0));
    }
}

// Returns the directional albedo of the coat's lobe.
BN_FN dfg_value clearcoat_albedo(frame_ref f, BN_IN(coating) layer, real n_dot_v)
{
    return ggx_coating_albedo(f, layer, n_dot_v);
}

// Returns the coat of a coated material; the parameters are explained in coating.t.h.
BN_FN coating clearcoat_coating(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_IN(surface_frame) axes, real3 v, real handedness)
{
    coating c;
    // Find the coat's normal and its horizon
    c.axes = axes;
    if (texture_used(m, kCoatNormalTex))
        c.axes = mapped_frame(axes, at.coat_normal_map, handedness);
    c.has_surface_horizon = texture_used(m, kCoatNormalTex) && the_frame(f).horizon != 0;
    c.horizon = c.axes.n;
    if (the_frame(f).horizon != 0)
        c.horizon = axes.n;
    // Find the coat's Fresnel weight at the view cosine
    real n_dot_v = k_saturate(k_dot3(c.axes.n, v));
    real3 reflected = fresnel_schlick(vec3_all(splat(the_material(m).clearcoat_f0)), vec3_all(lit(1.0)), n_dot_v);
    c.share = k_saturate(at.coat) * reflected.x;
    c.reflectance = vec3_all(c.share);
    c.roughness = k_saturate(at.coat_roughness);
    return c;
}

BN_KERNELS_END

#endif
