// From a material at a visible point to the point that lights shade.
#ifndef BN_MAKE_SHADED_POINT_T_H
#define BN_MAKE_SHADED_POINT_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/visible_point.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/frame_by_map.t.h"
#include "shading/surface/lobe_energy.t.h"
#include "shading/surface/lobe_shape.t.h"
#include "shading/surface/material.t.h"
#include "shading/surface/reflectance.t.h"
#include "shading/surface/refraction.t.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Returns true where transmitted light comes from beyond the near side of a body. A thin body has two near sides.
BN_FN mask enters_body(frame_ref f, material_ref m, mask front)
{
    bool thin = the_frame(f).glass != 0 && the_material(m).thin != 0 && (the_material(m).technique_traits & kSamplesInterface) == 0;
    return either(front, int_lit(thin ? 1 : 0) != int_lit(0));
}

// Makes the interface of a transmissive material: the interface takes a share of the diffuse part. Where it is sampled, its
// own gain replaces x.energy.gain.
BN_STAGE void make_interface(any_frame f, material_ref m, BN_IN(material_inputs) at, mask front, BN_INOUT(shaded_point) x)
{
    x.transmission.inputs.parts = fresnel_parts_of(f, m, at);
    mask enters = enters_body(f, m, front);
    x.transmission.inputs.parts.ior = index_of_far_side(splat(the_material(m).ior), enters);
    x.transmission.inputs.parts.film_side = x.transmission.inputs.parts.ior;
    x.transmission.body = both(enters, int_lit(the_frame(f).glass) != int_lit(0));
    x.transmission.inputs.tint = x.s.diffuse * at.transmission;
    x.transmission.inputs.dispersion = splat(the_material(m).dispersion);
    x.s.diffuse = x.s.diffuse * (lit(1.0) - at.transmission);
    if (!x.transmission.samples_interface)
        return;
    x.energy.gain = vec3_all(lit(1.0));
    if (the_frame(f).energy_compensation != 0)
        x.energy.gain = vec3_all(lit(1.0) / max(interface_albedo(rough_interface_at(x)), lit(0.05)));
}

// Returns the geometry's frame; a surface seen from behind shows its other side.
BN_FN real facing_handedness(BN_IN(visible_point) p)
{
    real sign = BN_MUTANT(handedness_ignored, p.tangent_sign, lit(1.0));
    return select(p.front, sign, -sign);
}
BN_FN surface_frame facing_geometric_axes(BN_IN(visible_point) p)
{
    real3 normal = select(p.front, p.normal, -p.normal);
    return geometric_frame(normal, p.tangent, facing_handedness(p));
}

// Returns the lobe's frame: the geometry's frame turned by the normal map, then tilted.
BN_FN surface_frame lobe_axes(frame_ref f, material_ref m, BN_IN(material_inputs) at, surface_frame axes, real handedness)
{
    if (texture_used(m, kNormalTex))
        axes = frame_by_map(m, axes, at.normal_map, handedness);
    if (lies_in_surface(f) && the_material(m).tilt_mapped != 0) {
        real2 slope = at.slope + vec2_of(splat(the_material(m).tilt_slope[0]), splat(the_material(m).tilt_slope[1]));
        axes = sloped_frame(axes, slope);
    } else if (lies_in_surface(f))
        axes = tilted_frame(axes, vec2_of(splat(the_material(m).tilt_cos[0]), splat(the_material(m).tilt_cos[1])),
                            vec2_of(splat(the_material(m).tilt_sin[0]), splat(the_material(m).tilt_sin[1])));
    return axes;
}

// Puts the material's film over x.s, whose reflectances are set.
BN_STAGE void put_film(any_frame f, any_material m, BN_IN(material_inputs) at, BN_INOUT(shaded_point) x)
{
    // Keep Schlick's approximation for what has no film, unless the frame wants it exact
    if (x.s.exact == 0) {
        real ior = splat(the_material(m).ior);
        if (the_material(m).refracts != 0 && !x.transmission.samples_interface)
            ior = x.s.parts.ior;
        x.s.parts = fresnel_parts_of(f, m, at);
        x.s.parts.dielectric = lit(0.0);
        x.s.parts.conductor = lit(0.0);
        x.s.parts.ior = ior;
        x.s.parts.rest_f0 = x.s.f0;
        x.s.parts.rest_f90 = x.s.f90;
    }
    x.s.exact = x.s.exact + kFilmReflects;
    if (the_material(m).refracts != 0 && !x.transmission.samples_interface)
        x.s.parts.film_side = x.s.parts.ior;
    x.s.f0 = schlick_f0_of(exact_reflectance(x.s.parts, x.s.n_dot_v), x.s.f90, x.s.n_dot_v);
}

// Fills x.
BN_FN void make_shaded_point(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_IN(lobe_shape) shape, BN_IN(visible_point) p,
                             integer pixel_id, BN_INOUT(shaded_point) x)
{
    x.pixel_id = pixel_id;
    x.samples = the_material(m).samples;
    // Find the shading frame and the lobe
    real3 v = k_normalize3(-p.ray);
    x.geometric_axes = facing_geometric_axes(p);
    surface_frame axes = lobe_axes(f, m, at, x.geometric_axes, facing_handedness(p));
    x.has_surface_horizon = (texture_used(m, kNormalTex) && the_frame(f).horizon != 0) || can_tilt(f, m);
    x.lobe = lobe_in_frame(m, shape, axes);
    // Set up the surface and its reflectances
    x.diffuse = the_material(m).metallic < 1.0f || texture_used(m, kMetalRoughTex);
    x.dielectric_f0 = at.dielectric_f0;
    x.dielectric_f90 = at.dielectric_f90;
    x.s = metallic_roughness_surface(axes.n, v, at.base, at.metallic, shape.roughness, at.dielectric_f0, at.dielectric_f90, at.occlusion);
    // Use exact reflectances where the frame wants them
    x.s.exact = the_frame(f).fresnel;
    if (x.s.exact != 0) {
        x.s.parts = fresnel_parts_of(f, m, at);
        x.s.f0 = exact_reflectance(x.s.parts, lit(1.0));
    }
    // Reflect from within as a mirror does, with total reflection
    x.transmission.refracts = the_material(m).refracts != 0;
    x.transmission.disperses = x.transmission.refracts && the_material(m).dispersion > 0.0f;
    x.transmission.samples_interface = (the_material(m).technique_traits & kSamplesInterface) != 0;
    if (the_material(m).refracts != 0 && (the_material(m).technique_traits & kSamplesInterface) == 0) {
        mask enters = enters_body(f, m, p.front);
        real ior = index_of_far_side(splat(the_material(m).ior), enters);
        real3 within = dielectric_reflectance(at.dielectric_f0, at.dielectric_f90, ior, x.s.n_dot_v);
        x.s.f0 = select(enters, x.s.f0, within);
        x.s.f90 = select(enters, x.s.f90, within);
        x.s.parts.ior = ior;
    }
    if (film_used() && the_material(m).film != 0)
        put_film(f, m, at, x);
    find_energy(f, m, at, x);
    if (the_material(m).refracts != 0) // x.transmission.refracts would not fold away here, and x would leave registers
        make_interface(f, m, at, p.front, x);
}

BN_KERNELS_END

#endif
