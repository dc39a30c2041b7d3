// A clear coat over a surface, by KHR_materials_clearcoat: an isotropic GGX lobe with index 1.5 about its own normal. The
// Fresnel factor uses the view cosine. So the coat takes that share of all incoming light, and the layer below, its
// emission included, has the rest: energy is conserved. (glTF 2.0, appendix B, "fresnel_coat".)
#ifndef BN_COAT_T_H
#define BN_COAT_T_H

#include "shading/kernels/fresnel.k.h"
#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/material.t.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

struct coat_layer {
    surface_frame axes; // about the coat's normal, which ignores the base layer's normal map
    real3 horizon;      // normal of the horizon; light from below it is not reflected
    real weight;        // of the coat's lobe, [0,1]; the layer below has 1 - weight
    real roughness;     // perceptual, [0,1]
};

// Returns the coat of a coated material. axes: the geometry's, facing the eye; v: to the eye, unit, world space;
// handedness: facing_handedness().
BN_FN coat_layer coat_of(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_IN(surface_frame) axes, real3 v, real handedness)
{
    coat_layer c;
    // Find the coat's normal and its horizon
    c.axes = axes;
    if (texture_used(m, kCoatNormalTex))
        c.axes = mapped_frame(axes, at.coat_normal_map, handedness);
    c.horizon = c.axes.n;
    if (the_frame(f).horizon != 0)
        c.horizon = axes.n;
    // Find the coat's Fresnel weight at the view cosine
    real n_dot_v = k_saturate(k_dot3(c.axes.n, v));
    real3 reflected = fresnel_schlick(vec3_all(lit(0.04)), vec3_all(lit(1.0)), n_dot_v);
    c.weight = k_saturate(at.coat) * reflected.x;
    c.roughness = k_saturate(at.coat_roughness);
    return c;
}

// Makes a point that lights and techniques can shade from the coat. axes: the geometry's; v: as in coat_of(); turned: the
// normal differs from the geometry's, and the frame tests the horizon. Fills c except members that only other lobes and
// random numbers use.
BN_FN void make_coat_point(frame_ref f, BN_IN(coat_layer) coat, BN_IN(surface_frame) axes, real3 v, real occlusion,
                           bool has_surface_horizon, BN_INOUT(shaded_point) c)
{
    // Set up a surface with the coat's specular part alone
    real3 whole = vec3_all(coat.weight);
    c.s.n = coat.axes.n;
    c.s.v = v;
    c.s.n_dot_v = min(max(k_dot3(coat.axes.n, v), lit(1e-4)), lit(1.0));
    c.s.diffuse = vec3_all(lit(0.0));
    c.s.f0 = whole;
    c.s.f90 = whole;
    c.s.roughness = coat.roughness;
    c.s.occlusion = occlusion;
    c.s.exact = 0;
    // Set up a round lobe
    c.lobe.u_axis = coat.axes.t;
    c.lobe.v_axis = coat.axes.b;
    c.lobe.sigma_u = coat.roughness * coat.roughness * lit(0.70710678118654752);
    c.lobe.sigma_v = c.lobe.sigma_u;
    c.geometric_axes = axes;
    c.has_surface_horizon = has_surface_horizon;
    c.diffuse = false;
    c.anisotropy_blend = lit(0.0);
    // Look up directional albedo
    if (the_frame(f).dfg_fit != 0)
        c.dfg = dfg_fit(c.s.n_dot_v, coat.roughness);
    else
        c.dfg = dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, c.s.n_dot_v, coat.roughness);
    // Find albedo; a coat has no energy compensation
    c.albedo = albedo_of(c.s, c.dfg);
    c.phong_albedo = lit(-1.0);
    c.own_dfg.scale = lit(1.0);
    c.own_dfg.bias = lit(0.0);
    c.phong_set = -1;
    c.albedo_ratio = lit(1.0);
    c.whole = c.own_dfg;
    c.compensation = vec3_all(lit(1.0));
    c.gain = c.compensation;
    // Use the coat's weight as reflectance
    c.dielectric_f0 = whole;
    c.dielectric_f90 = coat.weight;
    c.refracts = false;
}

// Returns the coat's lobe, for samples and densities.
BN_FN bsdf_lobe coat_bsdf_lobe(BN_IN(shaded_point) c)
{
    return make_bsdf_lobe(lobe_that_has(kRoundLobe), c.lobe, c.s.n, c.s.v, c.geometric_axes);
}

BN_KERNELS_END

#endif
