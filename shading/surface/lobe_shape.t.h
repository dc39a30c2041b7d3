// From a material to its lobe: widths and axis, then the axes on a surface. Isotropic lobes need no axes of their own.
#ifndef BN_LOBE_SHAPE_T_H
#define BN_LOBE_SHAPE_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/covariance.k.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/material.t.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

struct lobe_shape {        // a lobe before its placement on a surface
    real sigma_u, sigma_v; // see aniso_lobe
    real2 u;               // the wide axis, along tangent and bitangent
    real roughness;        // perceptual roughness
};

// Makes a shape from widths and axis.
BN_FN lobe_shape shape_of_axes(slope_axes axes)
{
    // Copy the widths and the axis
    lobe_shape r;
    r.sigma_u = axes.sigma_u;
    r.sigma_v = axes.sigma_v;
    r.u = axes.u;
    // Find the perceptual roughness
    aniso_lobe lobe;
    lobe.u_axis = vec3_all(lit(0.0));
    lobe.v_axis = vec3_all(lit(0.0));
    lobe.sigma_u = r.sigma_u;
    lobe.sigma_v = r.sigma_v;
    r.roughness = lobe_roughness(lobe);
    return r;
}

// Returns the covariance of the material's own lobe, before the spread of normals or slopes widens it.
BN_FN slope_covariance own_covariance(frame_ref f, material_ref m, BN_IN(material_inputs) at)
{
    real roughness = min(max(at.roughness, lit(0.0)), lit(1.0));
    real alpha = BN_MUTANT(alpha_is_roughness, roughness * roughness, roughness);
    real2 rotation = vec2_of(splat(the_material(m).grain[0]), splat(the_material(m).grain[1]));
    if (the_frame(f).override_anisotropy != 0)
        return covariance_from_eta_tensor(roughness, splat(the_frame(f).anisotropy), rotation, at.tensor2);
    return covariance_from_tensors(alpha, splat(the_material(m).anisotropy_strength), rotation, at.tensor2, at.tensor4);
}

// Returns true where the spread of normals or slopes below a pixel widens lobes.
BN_FN bool widens_lobes(material_ref m)
{
    return the_material(m).moments == kMomentsOfTilt || the_material(m).moments == kMomentsOfAll;
}

// Returns the perceptual roughness of own_covariance().
BN_FN real own_roughness(frame_ref f, material_ref m, BN_IN(material_inputs) at)
{
    if (the_material(m).level_gain >= 0.0f)
        return at.own_roughness;
    lobe_shape own = shape_of_axes(axes_of_covariance(own_covariance(f, m, at)));
    return own.roughness;
}

// Returns the lobe at a point of a material.
BN_FN lobe_shape lobe_shape_of(frame_ref f, material_ref m, BN_IN(material_inputs) at)
{
    lobe_shape r;
    // Start with a round lobe
    real roughness = min(max(at.roughness, lit(0.0)), lit(1.0));
    real alpha = roughness * roughness;
    real sigma = alpha * lit(0.70710678118654752);
    r.sigma_u = sigma;
    r.sigma_v = sigma;
    r.u = vec2_of(lit(1.0), lit(0.0));
    r.roughness = at.roughness;
    if (the_material(m).anisotropic == 0)
        return r;
    // Take the covariance from the level's moments, or from the material
    slope_covariance covariance;
    if (the_material(m).moments == kMomentsOfAll)
        covariance = covariance_of_moments(at.slope, at.slope_moments);
    else
        covariance = own_covariance(f, m, at);
    // Add the spread of a tilt or normal map
    if (the_material(m).moments == kMomentsOfTilt) {
        slope_covariance more = covariance_of_moments(at.slope, at.slope_moments);
        covariance = sum_of_covariances(covariance, more);
    }
    // Find widths and axis
    return shape_of_axes(axes_of_covariance(covariance));
}

// Returns true where no texture changes the shape; only_lobe_shape() returns that constant shape.
BN_FN bool one_lobe_shape(material_ref m)
{
    bool textured = texture_used(m, kMetalRoughTex) && the_material(m).roughness_fixed == 0;
    return !textured && !texture_used(m, kTensor2Tex);
}

BN_FN lobe_shape only_lobe_shape(frame_ref f, material_ref m)
{
    material_inputs at;
    at.roughness = splat(the_material(m).roughness);
    at.tensor2 = vec3_of(lit(1.0), lit(0.0), lit(0.0));
    at.tensor4 = at.tensor2;
    at.slope = vec2_all(lit(0.0));
    at.slope_moments = vec3_all(lit(0.0));
    return lobe_shape_of(f, m, at);
}

// Places a lobe in a shading frame. Isotropic lobes keep the frame's axes.
BN_FN aniso_lobe lobe_in_frame(material_ref m, BN_IN(lobe_shape) shape, BN_IN(surface_frame) axes)
{
    // Take the frame's axes
    aniso_lobe lobe;
    lobe.sigma_u = shape.sigma_u;
    lobe.sigma_v = shape.sigma_v;
    lobe.u_axis = axes.t;
    lobe.v_axis = axes.b;
    if (the_material(m).anisotropic == 0)
        return lobe;
    // Rotate them to the lobe's wide axis
    real turned = BN_MUTANT(rotation_clockwise, shape.u.y, -shape.u.y);
    real3 wide = axes.t * shape.u.x + axes.b * turned;
    real3 narrow = axes.b * shape.u.x - axes.t * turned;
    lobe.u_axis = BN_MUTANT(axes_swapped, wide, narrow);
    lobe.v_axis = BN_MUTANT(axes_swapped, narrow, wide);
    return lobe;
}

BN_KERNELS_END

#endif
