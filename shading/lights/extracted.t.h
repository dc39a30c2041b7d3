// Reflected light from the environment's extracted lights: evenly bright ellipses on the sky, evaluated with the lobe itself. The
// prefiltered cubes leave them out.
#ifndef BN_EXTRACTED_T_H
#define BN_EXTRACTED_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/lights/extracted.k.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

// Returns true where `mc` samples the extracted lights with the environment: for interfaces, and for lobes without GGX normals that
// are not broad.
BN_FN bool extracted_lights_are_sampled(BN_IN(shaded_point) x, lobe_layer layer)
{
    return (layer_has(layer, kNormals_own) && !layer_has(layer, kBroadLobe)) || interface_is_sampled(x);
}

struct extracted_light_lobe { // the lobe under extracted lights
    aniso_lobe lobe;
    bsdf_lobe bsdf;
    real3 eye;     // in the lobe's own frame
    real2 inverse; // 1 over its widths
};

// Makes the lobe. model: the lobe for punctual lights. Where it is round, the frame's lobe also becomes round, with the
// same roughness.
BN_FN extracted_light_lobe extracted_light_lobe_of(BN_IN(shaded_point) x, int model, lobe_layer layer)
{
    real root2 = lit(1.4142135623730951);
    real one = lit(1.0);
    extracted_light_lobe r;
    // Make the lobe round where the lights' lobe is
    r.lobe = x.lobe;
    if (lobe_has(model, kLies_round)) {
        r.lobe.sigma_u = x.s.roughness * x.s.roughness * lit(0.70710678118654752);
        r.lobe.sigma_v = r.lobe.sigma_u;
    }
    // Place the lobe, and find the eye in its frame
    r.bsdf = make_bsdf_lobe(layer.lobe, r.lobe, x.s.n, x.s.v, x.geometric_axes);
    r.eye = r.bsdf.o;
    if (layer_has(layer, kLies_surface))
        r.eye = to_lobe(r.lobe, x.s.n, x.s.v);
    // For masking only: normals at silhouettes may face away from the eye, and lobes flare up there
    if (!layer_has(layer, kBroadLobe))
        r.bsdf.o.z = max(r.bsdf.o.z, lit(0.02));
    // Find the inverse widths
    real alpha_u = r.lobe.sigma_u * root2;
    real alpha_v = r.lobe.sigma_v * root2;
    r.inverse = vec2_of(one / usable_alpha(alpha_u), one / usable_alpha(alpha_v));
    return r;
}

// Returns a light's share of the lobe: the integral of the density of slopes over the light's ellipse. h: half vector of its centre, any
// length, h.z above 0; up: 1 / h.z; u, v: changes of h along the light's half axes; all in the lobe's frame.
BN_FN real share_of_slopes(BN_IN(extracted_light_lobe) lobe, real3 h, real up, real3 u, real3 v)
{
    // Find the light's centre among slopes, in lobe widths
    real slope_x = h.x * up;
    real slope_y = h.y * up;
    real over_x = up * lobe.inverse.x;
    real over_y = up * lobe.inverse.y;
    real2 centre = vec2_of(slope_x * lobe.inverse.x, slope_y * lobe.inverse.y);
    // Slopes change by (w.xy - slope w.z) / h.z as h moves by w
    real2 at_u = vec2_of((u.x - slope_x * u.z) * over_x, (u.y - slope_y * u.z) * over_y);
    real2 at_v = vec2_of((v.x - slope_x * v.z) * over_x, (v.y - slope_y * v.z) * over_y);
    // Keep the ellipse within a quarter of the way to level half vectors, where slopes become infinite
    real steep = lit(16.0) * (u.z * u.z + v.z * v.z) * up * up;
    real parts = max(steep, lit(1.0));
    // Integrate the lobe over the ellipse
    slope_ellipse ellipse = slope_ellipse_of(centre, at_u, at_v, lit(1.0) / parts);
    return min(ggx_share_of_ellipse(ellipse) * parts, lit(1.0));
}

struct extracted_light_reflection {
    real lobe;    // specular radiance over the light's radiance, without Fresnel
    real cosine;  // the light's cosine at the surface, for the diffuse part
    real v_dot_h; // for Fresnel
};

// Computes the reflection of extracted light number `light`.
BN_FN extracted_light_reflection extracted_light_reflection_of(frame_ref f, BN_IN(shaded_point) x, BN_IN(extracted_light_lobe) lobe,
                                                               int light, lobe_layer layer)
{
    // Test the lobe's horizon
    real3 direction = splat3(the_frame(f).extracted_lights[light].direction);
    real3 l = to_lobe(lobe.lobe, x.s.n, direction);
    real3 in_place = l;
    if (layer_has(layer, kLies_surface))
        in_place = to_frame(lobe.bsdf.axes, direction);
    mask risen = in_place.z > lit(0.0);
    // Set up the diffuse part; stop where the light is hidden or sampled
    extracted_light_reflection r;
    r.lobe = lit(0.0);
    r.cosine = max(l.z, lit(0.0));
    // Test the surface's own horizon
    if (x.has_surface_horizon) {
        mask above = k_dot3(x.geometric_axes.n, direction) > lit(0.0);
        risen = both(risen, above);
        r.cosine = select(above, r.cosine, lit(0.0));
    }
    r.v_dot_h = lit(0.0);
    if (no_lane(risen) || extracted_lights_are_sampled(x, layer))
        return r;
    // Transform the light's half axes to the lobe's frame
    real3 u = to_lobe(lobe.lobe, x.s.n, splat3(the_frame(f).extracted_lights[light].axis_u));
    real3 v = to_lobe(lobe.lobe, x.s.n, splat3(the_frame(f).extracted_lights[light].axis_v));
    // Take a broad lobe for constant over the light
    if (layer_has(layer, kBroadLobe)) {
        real size = k_length3(k_cross(u, v)) * lit(3.14159265358979324);
        r.lobe = select(risen, bsdf_lobe_eval_cos(lobe.bsdf, direction) * size, lit(0.0));
        r.v_dot_h = bsdf_lobe_o_dot_h(lobe.bsdf, direction);
        return r;
    }
    real3 h = l + lobe.eye; // twice as long as the cosine between eye and half vector
    real h2 = k_dot3(h, h);
    real up = lit(1.0) / max(h.z, lit(1e-4));
    // Integrate the lobe over the light
    real share = share_of_slopes(lobe, h, up, u, v);
    real value = lit(2.0) * h2 * up * share * bsdf_lobe_masking(lobe.bsdf, in_place); // D dl = share 4 (v.h) / h.z, for the unit h
    r.lobe = select(risen, value, lit(0.0));
    real half_length = lit(0.5) * sqrt(h2);
    r.v_dot_h = k_saturate(half_length);
    return r;
}

// Returns transmitted radiance from extracted light number `light` over the light's radiance, with tint. The lobe's masking is
// the reflected one's at the same angle.
BN_FN real3 extracted_light_through(frame_ref f, BN_IN(shaded_point) x, BN_IN(extracted_light_lobe) lobe, int light)
{
    // Find the normal that refracts the light to the eye
    real ior = x.transmission.inputs.parts.ior;
    real side = select(ior >= lit(1.0), -ior, ior); // changes of that normal per change of the light's direction
    real towards = select(ior >= lit(1.0), lit(-1.0), lit(1.0));
    real3 l = to_lobe(lobe.lobe, x.s.n, splat3(the_frame(f).extracted_lights[light].direction));
    real3 h = lobe.eye * towards + l * side;
    real eye_side = k_dot3(lobe.eye, h);
    mask below = both(l.z < lit(0.0), k_dot3(l, h) < lit(0.0));
    mask passes = both(both(below, h.z > lit(0.0)), eye_side > lit(0.0));
    if (no_lane(passes))
        return vec3_all(lit(0.0));
    // Integrate the lobe over the light: D dl = share (v.h) / h.z, times the masking that reflection divides by 4 (n.v)
    real3 u = to_lobe(lobe.lobe, x.s.n, splat3(the_frame(f).extracted_lights[light].axis_u)) * side;
    real3 v = to_lobe(lobe.lobe, x.s.n, splat3(the_frame(f).extracted_lights[light].axis_v)) * side;
    real up = lit(1.0) / max(h.z, lit(1e-4));
    real share = share_of_slopes(lobe, h, up, u, v);
    real value = lit(4.0) * eye_side * up * share * bsdf_lobe_masking(lobe.bsdf, vec3_of(l.x, l.y, -l.z));
    real3 passed = interface_passes(x.transmission.inputs, eye_side / sqrt(max(k_dot3(h, h), lit(1e-20))));
    return select(passes, passed * value, vec3_all(lit(0.0)));
}

// Returns the extracted lights through clear glass: the picture with them minus the picture without.
BN_FN real3 extracted_lights_clear(frame_ref f, BN_IN(shaded_point) x)
{
    refracted_ray ray = refracted_ray_of(x.s.n, x.s.v, x.s.n_dot_v, x.s.roughness * x.s.roughness, x.transmission.inputs.parts.ior);
    real3 with = cube_sample_level(full_env(f), ray.direction, 0) * splat(the_frame(f).whole.scale);
    real3 without = cube_sample_level(prefiltered_env(f), ray.direction, 0) * splat(the_frame(f).specular.scale);
    return (with - without) * x.transmission.inputs.tint * diffuse_energy_share(f, x);
}

// Returns transmitted light from all extracted lights. model, layer: see light_from_extracted_lights(); mirror: share of a lobe
// without width, [0,1]. Makes its own lobe, so that the caller's stays in registers.
BN_STAGE real3 extracted_lights_through(any_frame f, BN_IN(shaded_point) x, int model, lobe_layer layer, real mirror)
{
    extracted_light_lobe lobe = extracted_light_lobe_of(x, model, layer);
    real3 sum = vec3_all(lit(0.0));
    for (int i = 0; i < the_frame(f).extracted_light_count; ++i)
        sum = sum + splat3(the_frame(f).extracted_lights[i].radiance) * extracted_light_through(f, x, lobe, i);
    if (any_lane(mirror > lit(0.0)))
        sum = sum + (extracted_lights_clear(f, x) - sum) * mirror;
    return sum;
}

// Returns the extracted lights in a mirror: the picture with them minus the picture without.
BN_FN real3 extracted_lights_mirrored(frame_ref f, BN_IN(shaded_point) x, BN_IN(bsdf_lobe) lobe)
{
    real3 r = x.s.n * (lit(2.0) * k_dot3(x.s.n, x.s.v)) - x.s.v;
    real3 with = cube_sample_level(full_env(f), r, 0) * splat(the_frame(f).whole.scale);
    real3 without = cube_sample_level(prefiltered_env(f), r, 0) * splat(the_frame(f).specular.scale);
    real3 shown = (with - without) * x.energy.albedo * bsdf_lobe_mirror_albedo(lobe);
    if (x.has_surface_horizon)
        return select(k_dot3(x.geometric_axes.n, r) > lit(0.0), shown, vec3_all(lit(0.0)));
    return shown;
}

// Returns reflected light from all extracted lights. Lobes narrower than the narrowest evaluated one blend into a mirror, which
// shows the lights as the environment has them. Occlusion dims everything. Where samples meet the lights with the
// environment, only mirrors and the diffuse part are evaluated here. model: see extracted_light_lobe_of(). layer: the layer that x stands
// for.
BN_FN real3 light_from_extracted_lights(frame_ref f, BN_IN(shaded_point) x, int model, lobe_layer layer)
{
    extracted_light_lobe lobe = extracted_light_lobe_of(x, model, layer);
    real3 specular = vec3_all(lit(0.0));
    real3 irradiance = vec3_all(lit(0.0));
    // Sum the lights' specular and diffuse parts
    for (int i = 0; i < the_frame(f).extracted_light_count; ++i) {
        // Evaluate the lobe with Fresnel
        extracted_light_reflection r = extracted_light_reflection_of(f, x, lobe, i, layer);
        real3 fresnel = reflectance_of(x.s, r.v_dot_h);
        specular = specular + splat3(the_frame(f).extracted_lights[i].radiance) * fresnel * r.lobe;
        // Add irradiance for the diffuse part
        real fallen = r.cosine;
        if (the_frame(f).diffuse_model != 0)
            fallen = fallen * diffuse_lit(f, r.cosine);
        irradiance = irradiance + splat3(the_frame(f).extracted_lights[i].irradiance) * fallen;
    }
    // Blend narrow lobes into a mirror
    real narrowness = lit(1.0) - lobe.lobe.sigma_u * lit(1414.2135623730951); // 0 from the least width on, alpha = 0.001
    real mirror = k_saturate(narrowness);
    if (layer_has(layer, kBroadLobe))
        mirror = lit(0.0);
    // Leave lobes that samples evaluate, unless they are mirrors
    if (extracted_lights_are_sampled(x, layer)) {
        real width = lobe.lobe.sigma_u + lobe.lobe.sigma_v;
        mirror = select(width <= lit(1e-6), lit(1.0), lit(0.0));
        if (layer_has(layer, kPunctualOnly) || interface_is_sampled(x))
            mirror = lit(0.0);
    }
    if (any_lane(mirror > lit(0.0)))
        specular = specular + (extracted_lights_mirrored(f, x, lobe.bsdf) - specular) * mirror;
    // Apply gain and occlusion; add transmitted light and the diffuse part
    real3 sum = specular * x.energy.gain;
    if (x.transmission.refracts && !x.transmission.samples_interface &&
        any_lane(not_(x.transmission.body))) // transmitted_light() adds them behind bodies
        sum = sum + select(x.transmission.body, vec3_all(lit(0.0)), extracted_lights_through(f, x, model, layer, mirror));
    if (x.diffuse) {
        real passed = diffuse_energy_share(f, x) * lit(0.31830988618379067);
        sum = sum + x.s.diffuse * irradiance * passed;
    }
    real3 seen = sum * x.s.occlusion;
    return seen;
}

BN_KERNELS_END

#endif
