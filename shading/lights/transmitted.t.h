// Light through transmissive surfaces, by prefiltered fetches for a whole lobe. Light enters and leaves a body. At a single interface it
// comes from inside the material.
#ifndef BN_TRANSMITTED_T_H
#define BN_TRANSMITTED_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/lights/behind.t.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

// A fragment whose lobe transmits.
struct transmitting_place {
    real3 position; // world space, metres; only where the frame has a picture of surfaces behind
    real pixel;     // size of a pixel there, metres
    mask body;      // light leaves by a second interface
};

// Returns the level of the prefiltered environment for a lobe. spread: refracted_ray's. The level belongs to a reflected lobe as wide as
// the transmitted one.
BN_FN real transmitted_level(cube_desc cube, real alpha, real spread)
{
    return sqrt(min(alpha * spread * lit(0.5), lit(1.0))) * to_real(int_lit(cube.levels - 1));
}

// Returns an extracted light's mean radiance over a transmitted lobe. direction: the lobe's middle, unit; deviation: of its directions.
BN_FN real3 extracted_light_along(frame_ref f, int light, BN_IN(real3) direction, real deviation)
{
    real3 u = splat3(the_frame(f).extracted_lights[light].axis_u);
    real3 v = splat3(the_frame(f).extracted_lights[light].axis_v);
    real3 off = direction - splat3(the_frame(f).extracted_lights[light].direction);
    // Blur the light by the lobe; a quarter of the squared half axes is an ellipse's own variance
    real variance = deviation * deviation + (k_dot3(u, u) + k_dot3(v, v)) * lit(0.125);
    real share = k_exp2(k_dot3(off, off) / variance * lit(-0.72134752044448170)) / (variance * lit(6.2831853071795865));
    real3 blurred = splat3(the_frame(f).extracted_lights[light].irradiance) * share;
    return min(blurred, splat3(the_frame(f).extracted_lights[light].radiance));
}

// Returns the light that one lobe transmits. n: normal, unit; alpha: the lobe's width; parts: of the interface.
BN_STAGE real3 fetch_transmitted(any_frame f, any_material m, BN_IN(shaded_point) x, BN_IN(transmitting_place) at, BN_IN(real3) n,
                                 real alpha, BN_IN(fresnel_parts) parts)
{
    real n_dot_v = max(k_dot3(n, x.s.v), lit(1e-4));
    refracted_ray ray = refracted_ray_of(n, x.s.v, n_dot_v, alpha, parts.ior);
    cube_desc cube = prefiltered_env(f);
    real scale = splat(the_frame(f).specular.scale);
    real3 one = vec3_all(lit(0.0)); // light at a single interface
    if (any_lane(not_(at.body)))
        one = cube_sample(cube, ray.direction, transmitted_level(cube, alpha, ray.spread)) * scale;
    if (no_lane(at.body))
        return one;
    // Follow the light through the body
    real extent = splat(the_material(m).body_extent);
    real roundness = splat(the_material(m).body_roundness);
    body_way way = way_through_body(ray, x.geometric_axes.n, parts.ior, extent, roundness);
    real3 light = cube_sample(cube, way.direction, transmitted_level(cube, alpha, way.spread)) * scale;
    for (int i = 0; i < the_frame(f).extracted_light_count; ++i)
        light = light + extracted_light_along(f, i, way.direction, alpha * way.spread * lit(0.70710678118654752));
    // Put opaque surfaces before the environment. A ball's normals turn over a pixel, and so does the light's direction.
    if (the_frame(f).behind >= 0) {
        real turned = roundness * lit(4.0) * at.pixel / (max(extent, lit(1e-6)) * max(n_dot_v, lit(0.1)));
        real4 behind =
            surfaces_behind(f, at.position + way.exit, way.direction, at.pixel, lit(2.0) * alpha * way.spread + turned * way.spread);
        light = light * (lit(1.0) - behind.w) + vec3_of(behind.x, behind.y, behind.z);
    }
    // The far side reflects a share, which leaves elsewhere; a rough side's facets are met less obliquely
    real met = sqrt(way.cosine * way.cosine + alpha * alpha * (lit(1.0) - way.cosine * way.cosine));
    real3 back = dielectric_reflectance(x.dielectric_f0, x.dielectric_f90, parts.ior, met);
    if (film_used() && the_material(m).film != 0)
        back = filmed_dielectric(parts, back, met);
    body_way further = way_through_body(reflected_inside(ray, way), way.normal, parts.ior, extent, roundness);
    real3 elsewhere = cube_sample(cube, further.direction, transmitted_level(cube, alpha, further.spread)) * scale;
    light = light + (elsewhere - light) * back;
    // Absorb light inside; the second interface takes the tint again
    real3 decay = splat3(the_material(m).body_decay) * way.distance;
    real3 left = vec3_of(k_exp2(decay.x), k_exp2(decay.y), k_exp2(decay.z)) * x.transmission.inputs.tint;
    return select(at.body, light * left, one);
}

// Returns transmitted light of the environment and of surfaces behind: one fetch, and for a stretched lobe two more beside it along the
// wide axis, with weights 1/4, 1/2, 1/4. Each fetch has half of the wide width, or the narrow width if that is larger; the distances give
// the rest. position: of the surface, world space.
BN_STAGE real3 transmitted_light(any_frame f, any_material m, BN_IN(shaded_point) x, BN_IN(real3) position)
{
    transmitting_place at;
    at.position = position;
    at.body = x.transmission.body;
    view_params view = view_params_of(the_frame(f).view);
    real away = select(view.orthographic, lit(1.0), k_dot3(view.forward, position - view.eye));
    at.pixel = away / (view.inv_tan_y * splat(the_frame(f).half_height));
    // Find both widths
    real root2 = lit(1.4142135623730951);
    real wide = max(x.lobe.sigma_u, x.lobe.sigma_v) * root2;
    real narrow = min(x.lobe.sigma_u, x.lobe.sigma_v) * root2;
    real width = max(narrow, wide * lit(0.5));
    real slope = sqrt(max(wide * wide - width * width, lit(0.0)));
    // Fetch in the middle and beside it, by one text: drivers compile each call anew
    real3 beside = select(x.lobe.sigma_u > x.lobe.sigma_v, x.lobe.u_axis, x.lobe.v_axis) * slope;
    real3 radiance = vec3_all(lit(0.0));
    bool wide_lobe = any_lane(slope > lit(0.0));
    int fetches = wide_lobe ? 3 : 1;
    for (int k = 0; k < (x.transmission.disperses ? 3 * fetches : fetches); ++k) {
        int i = k % fetches;
        real side = to_real(int_lit(i == 0 ? 0 : i * 2 - 3)); // 0, -1, 1
        real3 n = k_normalize3(x.s.n + beside * side);
        real weight = select(slope > lit(0.0), lit(i == 0 ? 0.5 : 0.25), lit(i == 0 ? 1.0 : 0.0));
        // Refract each channel by its own index where they differ
        int channel = k / fetches;
        interface_inputs through = x.transmission.inputs;
        if (x.transmission.disperses)
            through = interface_of_channel(x.transmission.inputs, to_real(int_lit(channel)));
        real3 light = fetch_transmitted(f, m, x, at, n, width, through.parts) * weight;
        if (x.transmission.disperses)
            light = channel_alone(light, channel);
        radiance = radiance + light;
    }
    if (film_used() && the_material(m).film != 0)
        return radiance * x.transmission.inputs.tint * transmittance_under_film(f, x) * x.s.occlusion;
    return radiance * x.transmission.inputs.tint * (diffuse_energy_share(f, x) * x.s.occlusion);
}

BN_KERNELS_END

#endif
