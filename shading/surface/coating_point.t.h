// A coating as a point that lights and techniques can shade.
#ifndef BN_COATING_POINT_T_H
#define BN_COATING_POINT_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/coating.t.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Fills c, except members that only other lobes and random numbers use. axes: the geometry's; v: to the eye, unit, world
// space; albedo: of the coating's lobe; has_surface_horizon: the frame tests the geometry's horizon.
BN_FN void make_coating_point(BN_IN(coating) layer, BN_IN(dfg_value) albedo, BN_IN(surface_frame) axes, real3 v, real occlusion,
                              bool has_surface_horizon, BN_INOUT(shaded_point) c)
{
    // Set up a surface with the coating's specular part alone
    c.s.n = layer.axes.n;
    c.s.v = v;
    c.s.n_dot_v = coating_n_dot_v(layer, v);
    c.s.diffuse = vec3_all(lit(0.0));
    c.s.f0 = layer.reflectance;
    c.s.f90 = layer.reflectance;
    c.s.roughness = layer.roughness;
    c.s.occlusion = occlusion;
    c.s.exact = 0;
    // Set up a round lobe
    c.lobe.u_axis = layer.axes.t;
    c.lobe.v_axis = layer.axes.b;
    c.lobe.sigma_u = layer.roughness * layer.roughness * lit(0.70710678118654752);
    c.lobe.sigma_v = c.lobe.sigma_u;
    c.geometric_axes = axes;
    c.has_surface_horizon = has_surface_horizon;
    c.diffuse = false;
    // Find albedo; a coating has no energy compensation
    c.energy.dfg = albedo;
    c.energy.albedo = albedo_of(c.s, c.energy.dfg);
    c.energy.phong_albedo = lit(-1.0);
    c.energy.own_dfg.scale = lit(1.0);
    c.energy.own_dfg.bias = lit(0.0);
    c.energy.phong_set = -1;
    c.energy.albedo_ratio = lit(1.0);
    c.energy.whole = c.energy.own_dfg;
    c.energy.compensation = vec3_all(lit(1.0));
    c.energy.gain = c.energy.compensation;
    // Use the coating's reflectance for all light
    c.dielectric_f0 = layer.reflectance;
    c.dielectric_f90 = layer.share;
    c.transmission.refracts = false;
    c.transmission.disperses = false;
    c.transmission.samples_interface = false;
}

BN_KERNELS_END

#endif
