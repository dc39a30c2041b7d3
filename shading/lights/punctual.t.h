// Reflected light from the frame's punctual lights.
#ifndef BN_PUNCTUAL_T_H
#define BN_PUNCTUAL_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/lights/punctual.k.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

struct punctual_light {
    real3 l;        // unit, to the light
    real3 radiance; // reflected towards the eye
};

// Returns the direction to a light and its attenuation.
BN_FN light_sample light_towards(frame_ref f, real3 position, int light)
{
    return sample_punctual(position, splat3(the_light(f, light).position), splat3(the_light(f, light).direction),
                           splat(the_light(f, light).inv_range2), splat(the_light(f, light).spot_scale),
                           splat(the_light(f, light).spot_offset), int_lit(the_light(f, light).directional) != int_lit(0));
}

// Returns the diffuse BRDF for light at that cosine, 1/sr. diffuse: diffuse_brdf() of x.
BN_FN real3 diffuse_under_light(frame_ref f, BN_IN(real3) diffuse, real n_dot_l)
{
    if (the_frame(f).diffuse_model == 0)
        return diffuse;
    return diffuse * diffuse_lit(f, max(n_dot_l, lit(0.0)));
}

// Returns reflected radiance from one light. lobe: x's, under lights. diffuse: diffuse_brdf(). at: light_towards().
BN_FN punctual_light light_from(frame_ref f, BN_IN(shaded_point) x, BN_IN(bsdf_lobe) lobe, BN_IN(real3) diffuse, light_sample at, int light)
{
    // Find irradiance, reflectance and the diffuse part
    real3 intensity = splat3(the_light(f, light).radiant) * at.attenuation;
    real3 reflectance = reflectance_of(x.s, punctual_v_dot_h(x.s, at.l));
    real3 dull = diffuse_under_light(f, diffuse, k_dot3(x.s.n, at.l));
    // Evaluate the lobe, with the cosine if its value includes one
    punctual_light r;
    r.l = at.l;
    if (lobe_has(lobe.model, kLies_surface + kLies_thread))
        r.radiance = punctual_radiance_apart(x.s, at.l, bsdf_lobe_eval_cos(lobe, at.l), reflectance, dull, x.energy.gain, intensity);
    else
        r.radiance = punctual_radiance(x.s, at.l, bsdf_lobe_light(lobe, x.s, at.l), reflectance, dull, x.energy.gain, intensity);
    return r;
}

// Returns the same for a transmissive surface: its interface replaces the lobe.
BN_STAGE punctual_light light_from_interface(any_frame f, BN_IN(shaded_point) x, BN_IN(rough_interface) g, BN_IN(real3) diffuse,
                                             light_sample at, int light)
{
    // Find irradiance and the diffuse part
    real3 intensity = splat3(the_light(f, light).radiant) * at.attenuation;
    real n_dot_l = max(k_dot3(x.s.n, at.l), lit(0.0));
    real3 dull = diffuse_under_light(f, diffuse, n_dot_l) * n_dot_l;
    // Add the interface's reflection
    real3 shiny = interface_value(g, at.l) * x.energy.gain;
    punctual_light r;
    r.l = at.l;
    r.radiance = (dull + shiny) * intensity;
    return r;
}

// Sums all punctual lights. model: the lobe for lights, for surfaces that do not transmit. position: x's, world space.
BN_FN real3 light_from_punctual(frame_ref f, BN_IN(shaded_point) x, int model, real3 position)
{
    real3 sum = vec3_all(lit(0.0));
    // Prepare the lobe, the diffuse part and the interface
    bsdf_lobe lobe = bsdf_lobe_under_lights(model, x.lobe, x.s, x.geometric_axes);
    real3 diffuse = vec3_all(lit(0.0));
    if (x.diffuse)
        diffuse = diffuse_brdf(f, x);
    rough_interface through;
    if (x.transmission.refracts)
        through = rough_interface_at(x);
    // Visit the lights in reach
    light_reach reach = lights_reaching(f, position);
    for (int i = next_light(f, reach); i < the_frame(f).light_count; i = next_light(f, reach)) {
        light_sample at = light_towards(f, position, i);
        if (no_lane(at.attenuation > lit(0.0))) // out of range or cone
            continue;
        // Shade the light, and cut light from below the surface's horizon
        punctual_light light;
        if (x.transmission.refracts)
            light = light_from_interface(f, x, through, diffuse, at, i);
        else
            light = light_from(f, x, lobe, diffuse, at, i);
        // Test the surface's horizon
        if (x.has_surface_horizon)
            light.radiance = select(k_dot3(x.geometric_axes.n, light.l) > lit(0.0), light.radiance, vec3_all(lit(0.0)));
        sum = sum + light.radiance;
    }
    return sum;
}

BN_KERNELS_END

#endif
