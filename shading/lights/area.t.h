// Reflected light from the frame's area lights, without shadows. A transformed cosine replaces the specular lobe, a plain
// cosine the diffuse part; the light covers some share of each. One lookup of the lobe serves all lights. The alternative
// is Monte Carlo over points of the lights.
#ifndef BN_AREA_T_H
#define BN_AREA_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/lights/area_picture.t.h"
#include "shading/lights/area_point.t.h"
#include "shading/lights/area_sample.t.h"
#include "shading/lights/environment.t.h"
#include "shading/lights/ltc_polygon.k.h"
#include "shading/lights/ltc_round.k.h"
#include "shading/lights/ltc_table.k.h"
#include "shading/lights/punctual.k.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

BN_FN bool area_is_flat(frame_ref f, int light)
{
    return the_area_light(f, light).shape <= kArea_disk;
}

// Returns true where a one-sided light shows its bright side; false from within its plane.
BN_FN mask area_faces(frame_ref f, int light, real3 position)
{
    real towards = k_dot3(area_point(f, light, 0) - position, splat3(the_area_light(f, light).normal));
    if (!area_is_flat(f, light) || the_area_light(f, light).two_sided != 0)
        return towards == towards;
    return towards < lit(0.0);
}

// A light as seen from a point: in a lobe's axes, relative to the point.
struct area_view {
    int shape, corners;
    real radius;
    ltc_polygon at; // its points; for a disk the centre and half axes
};

// Returns the part above a plane through the point. Discs become polygons, and spheres become the discs of their outlines.
// normal: the plane's, upwards, in the lobe's axes.
BN_STAGE area_view area_above(BN_IN(area_view) v, BN_IN(real3) normal)
{
    area_view r = v;
    // Clip a line's ends
    if (v.shape == kArea_line) {
        // Find the heights of both ends
        real a = k_dot3(v.at.corner[0], normal);
        real b = k_dot3(v.at.corner[1], normal);
        real start = k_saturate(-a / select(b - a > lit(1e-30), b - a, lit(1e30)));
        real end = k_saturate(-b / select(a - b > lit(1e-30), a - b, lit(1e30)));
        // Move ends below to the plane
        real3 span = v.at.corner[1] - v.at.corner[0];
        mask below = both(a <= lit(0.0), b <= lit(0.0));
        r.at.corner[0] = v.at.corner[0] + span * start;
        r.at.corner[1] = select(below, r.at.corner[0], v.at.corner[1] - span * end);
        return r;
    }
    // Turn discs and spheres into polygons
    if (v.shape == kArea_disk || v.shape == kArea_sphere) {
        // Take the ellipse, or the outline of a sphere
        real3 middle = v.at.corner[0];
        real3 p = v.at.corner[1];
        real3 q = v.at.corner[2];
        if (v.shape == kArea_sphere) {
            ltc_outline outline = ltc_sphere_outline(middle, v.radius, normal);
            middle = outline.middle;
            p = outline.axis_a;
            q = outline.axis_b;
        }
        // Place corners around the ellipse
        for (int k = 0; k < 16; ++k) { // 16 corners; the polygon has the ellipse's area
            k_sin_cos_pair turn = k_sin_cos(splat(float(k)) * lit(0.39269908169872415));
            r.at.corner[k] = middle + (p * turn.cosine + q * turn.sine) * lit(1.0130015562559769);
        }
        r.shape = kArea_polygon;
        r.corners = 16;
    }
    // Clip the polygon
    r.at = ltc_polygon_above(r.at, r.corners, normal);
    r.corners = r.corners + 1;
    return r;
}

// Returns the light as seen from a position, in the lobe's axes.
BN_FN area_view area_seen_by(frame_ref f, int light, aniso_lobe lobe, real3 n, real3 position)
{
    // Copy the shape
    area_view v;
    v.shape = the_area_light(f, light).shape;
    v.corners = the_area_light(f, light).corners;
    v.radius = splat(the_area_light(f, light).radius);
    // Transform its points; half axes are vectors, so they are not moved
    if (quads_apart() && v.shape <= kArea_polygon && v.corners == 4) {
        for (int k = 0; k < 4; ++k) {
            v.at.corner[k] = to_lobe(lobe, n, area_point(f, light, k) - position);
        }
        return v;
    }
    for (int k = 0; k < v.corners; ++k) {
        real3 p = area_point(f, light, k);
        if (v.shape == kArea_disk && k > 0)
            v.at.corner[k] = to_lobe(lobe, n, p);
        else
            v.at.corner[k] = to_lobe(lobe, n, p - position);
    }
    return v;
}

// Returns the light's share of a lobe by its shape.
BN_FN ltc_light area_through(BN_IN(area_view) v, BN_IN(ltc_lobe) lobe, bool clipless)
{
    if (v.shape == kArea_disk)
        return ltc_disk_light(lobe, v.at.corner[0], v.at.corner[1], v.at.corner[2]);
    if (v.shape == kArea_sphere)
        return ltc_sphere_light(lobe, v.at.corner[0], v.radius);
    if (v.shape == kArea_line)
        return ltc_line_light(lobe, v.at.corner[0], v.at.corner[1], v.radius);
    if (area_way_used(kAreaWay_ltc_clipless) && clipless)
        return ltc_polygon_clipless(lobe, v.at, v.corners);
    if (quads_apart() && v.corners == 4)
        return ltc_polygon_light(lobe, v.at, 4);
    return ltc_polygon_light(lobe, v.at, v.corners);
}

// Returns a light's share of a lobe and the direction of its flow. clipless: polygons skip clipping at the horizon; a
// sphere with the same form factor is clipped.
BN_STAGE ltc_light area_part(BN_IN(area_view) v, BN_IN(ltc_lobe) lobe, bool clipless)
{
    return area_through(v, lobe, clipless);
}

// Returns the same for a lobe tilted against its surface. The cosine stands for the untilted lobe, whose masking differs.
// So scale its share by the ratio of both lobes' values in the light's mean direction. lobe: x's.
BN_STAGE ltc_light area_part_tilted(any_frame f, BN_IN(area_view) v, BN_IN(ltc_lobe) cosine, bool clipless, BN_IN(shaded_point) x,
                                    BN_IN(aniso_lobe) lobe)
{
    ltc_light light = area_through(v, cosine, clipless);
    // Find the mean direction of the light
    real3 d = k_normalize3(cosine.m0 * light.flow.x + cosine.m1 * light.flow.y + cosine.m2 * light.flow.z + vec3_all(lit(1e-20)));
    surface_frame axes;
    axes.n = x.s.n;
    axes.t = lobe.u_axis;
    axes.b = lobe.v_axis;
    // Compare the tilted with the untilted lobe in that direction
    real3 wi = axes.t * d.x + axes.b * d.y + axes.n * d.z;
    int untilted = the_frame(f).masking != 0 ? lobe_that_has(kDefaultLobe) : the_frame(f).lobe;
    bsdf_lobe tilted = bsdf_lobe_at(f, x);
    bsdf_lobe upright = make_bsdf_lobe(untilted, lobe, x.s.n, x.s.v, axes);
    real share = bsdf_lobe_eval_cos(tilted, wi) / max(bsdf_lobe_eval_cos(upright, wi), lit(1e-12));
    // An eye below the lobe's own horizon sees no untilted lobe: use the ratio of albedos there.
    real above = k_saturate(k_dot3(x.s.n, x.s.v) * lit(10.0));
    real ratio = x.energy.albedo_ratio + (min(share, lit(4.0)) - x.energy.albedo_ratio) * above;
    light.part = light.part * ratio;
    return light;
}

// Looks up the transformed cosine for a lobe.
BN_FN ltc_lobe area_lobe(frame_ref f, real3 eye, real alpha_u, real alpha_v)
{
    // Look up round lobes in their own table
    if (area_way_used(kAreaWay_ltc_isotropic) && the_frame(f).area_way == kAreaWay_ltc_isotropic) {
        real both_widths = alpha_u * alpha_v;
        return ltc_round_lookup(ltc_texels(f), the_frame(f).ltc.round_first, eye, sqrt(both_widths));
    }
    // Describe the table
    ltc_table table;
    table.texels = ltc_texels(f);
    table.root_alpha = the_frame(f).ltc.root_alpha;
    table.basis = the_frame(f).ltc.basis;
    table.over_alpha = the_frame(f).ltc.over_alpha;
    table.inverse = the_frame(f).ltc.inverse;
    table.alphas = the_frame(f).ltc.alphas;
    return ltc_lookup(table, eye, alpha_u, alpha_v);
}

// Sums all area lights by transformed cosines. model: the lobe for lights; a round one lies about the normal with the
// surface's roughness. position: x's, world space. Other models count as GGX with the same widths; lobes for punctual
// lights alone give nothing. A turned normal clips lights at the surface's own horizon. layer: the layer that x stands for.
BN_FN real3 area_light_by_cosines(frame_ref f, BN_IN(shaded_point) x, int model, real3 position, lobe_layer layer)
{
    // Make the lobe round where the lights' lobe is
    aniso_lobe lobe = x.lobe;
    if (lobe_has(model, kLies_round)) {
        lobe.sigma_u = x.s.roughness * x.s.roughness * lit(0.70710678118654752);
        lobe.sigma_v = lobe.sigma_u;
    }
    // Look up the transformed cosine
    real root2 = lit(1.4142135623730951);
    real alpha_u = lobe.sigma_u * root2;
    real alpha_v = lobe.sigma_v * root2;
    ltc_lobe shiny = area_lobe(f, to_lobe(lobe, x.s.n, x.s.v), alpha_u, alpha_v);
    ltc_lobe dull = ltc_cosine();
    bool clipless = the_frame(f).area_way == kAreaWay_ltc_clipless;
    // Find the surface's horizon in the lobe's axes
    real3 up = vec3_of(lit(0.0), lit(0.0), lit(1.0));
    if (x.has_surface_horizon)
        up = to_lobe(lobe, x.s.n, x.geometric_axes.n);
    bool tilts = x.has_surface_horizon && uses_substitute_lobe(f) && layer_has(layer, kLies_surface);
    real3 specular = vec3_all(lit(0.0));
    real3 diffuse = vec3_all(lit(0.0));
    // Visit the lights that face the point
    for (int i = 0; i < the_frame(f).area_light_count; ++i) {
        mask faces = area_faces(f, i, position);
        if (no_lane(faces))
            continue;
        // View the light, with its sides where it has a picture
        area_view view = area_seen_by(f, i, lobe, x.s.n, position);
        bool pictured = the_area_light(f, i).picture >= 0;
        real3 corner = view.at.corner[0];
        real3 side_u = corner;
        real3 side_v = corner;
        if (pictured) {
            side_u = view.at.corner[1] - corner;
            side_v = view.at.corner[3] - corner;
        }
        // Clip at the surface's horizon
        if (x.has_surface_horizon)
            view = area_above(view, up);
        // Find the specular share
        real3 radiance = splat3(the_area_light(f, i).radiance);
        ltc_light seen;
        if (tilts)
            seen = area_part_tilted(f, view, shiny, clipless, x, lobe);
        else
            seen = area_part(view, shiny, clipless);
        // Add it with the light's or its picture's radiance
        if (pictured)
            radiance = area_radiance_through(f, i, shiny, seen.flow, corner, side_u, side_v);
        specular = specular + select(faces, radiance, vec3_all(lit(0.0))) * seen.part;
        // Add the diffuse share
        if (x.diffuse) {
            seen = area_part(view, dull, clipless);
            if (pictured)
                radiance = area_radiance_through(f, i, dull, seen.flow, corner, side_u, side_v);
            diffuse = diffuse + select(faces, radiance, vec3_all(lit(0.0))) * seen.part;
        }
    }
    // Apply albedo and gain
    dfg_value albedo;
    albedo.scale = shiny.all - shiny.grazing;
    albedo.bias = shiny.grazing;
    real3 sum = specular * albedo_of(x.s, albedo) * x.energy.gain;
    if (uses_substitute_lobe(f) && !tilts)
        sum = sum * x.energy.albedo_ratio;
    if (layer_has(layer, kPunctualOnly))
        sum = vec3_all(lit(0.0));
    // Add the diffuse part
    if (x.diffuse) {
        real passed = diffuse_energy_share(f, x);
        sum = sum + x.s.diffuse * diffuse * passed;
    }
    return sum;
}

// Sums all area lights by points on each, from a Hammersley set rotated by a hash of pixel and light.
BN_FN real3 area_light_by_samples(frame_ref f, BN_IN(shaded_point) x, int model, real3 position)
{
    // Prepare the lobe and the interface
    bsdf_lobe lobe = bsdf_lobe_under_lights(model, x.lobe, x.s, x.geometric_axes);
    bool apart = lobe_has(lobe.model, kLies_surface + kLies_thread); // its value includes the cosine
    rough_interface through;
    if (x.transmission.refracts)
        through = rough_interface_at(x);
    int n = the_frame(f).light_samples;
    uniform_real inv = 1.0f / float(n);
    // Seed the random rotation, and start the sums
    integer seed = k_hash_u32(x.pixel_id ^ int_lit(the_frame(f).seed));
    real3 specular = vec3_all(lit(0.0));
    real3 irradiance = vec3_all(lit(0.0));
    for (int i = 0; i < the_frame(f).area_light_count; ++i) {
        // Rotate the points by pixel and light
        real3 radiance = splat3(the_area_light(f, i).radiance) * splat(inv);
        bool pictured = the_area_light(f, i).picture >= 0;
        seed = k_hash_u32(seed ^ int_lit(i));
        real shift_x = k_unit_from_bits(seed);
        real shift_y = k_unit_from_bits(k_hash_u32(seed));
        // Visit the light's points
        for (int k = 0; k < n; ++k) {
            uniform_real column = (float(k) + 0.5f) * inv;
            real u = splat(column) + shift_x;
            real v = k_radical_inverse2(int_lit(k)) + shift_y;
            real2 xi = vec2_of(u - floor(u), v - floor(v));
            // Sample a point, and its radiance where the light has a picture
            area_sample s = area_sample_at(f, i, position, xi);
            if (pictured)
                radiance = area_radiance_at(f, i, position + s.wi * s.distance) * splat(inv);
            // Test the surface's horizon
            real cosine = max(k_dot3(x.s.n, s.wi), lit(0.0));
            mask seen = s.pdf > lit(0.0);
            if (x.has_surface_horizon)
                seen = both(seen, k_dot3(x.geometric_axes.n, s.wi) > lit(0.0));
            real weight = select(seen, lit(1.0) / max(s.pdf, lit(1e-20)), lit(0.0));
            // Evaluate the lobe or the interface
            real value = lit(0.0);
            if (apart)
                value = bsdf_lobe_eval_cos(lobe, s.wi);
            else
                value = select(cosine > lit(0.0), bsdf_lobe_light(lobe, x.s, s.wi), lit(0.0)) * cosine;
            // Add the specular part with Fresnel
            real3 fresnel = reflectance_of(x.s, punctual_v_dot_h(x.s, s.wi));
            real part = value * weight;
            real3 reflected = fresnel * part;
            if (x.transmission.refracts)
                reflected = interface_value(through, s.wi) * weight;
            specular = specular + radiance * reflected;
            // Add the diffuse irradiance
            real fallen = cosine * weight;
            if (the_frame(f).diffuse_model != 0)
                fallen = fallen * diffuse_lit(f, cosine);
            irradiance = irradiance + radiance * fallen;
        }
    }
    // Apply gain, and add the diffuse part
    real3 sum = specular * x.energy.gain;
    if (x.diffuse) {
        real passed = diffuse_energy_share(f, x) * lit(0.31830988618379067);
        sum = sum + x.s.diffuse * irradiance * passed;
    }
    return sum;
}

// Returns reflected light from all area lights by the frame's method.
BN_FN real3 light_from_area(frame_ref f, BN_IN(shaded_point) x, int model, real3 position, lobe_layer layer)
{
    if (area_way_used(kAreaWay_mc) && the_frame(f).area_way == kAreaWay_mc)
        return area_light_by_samples(f, x, model, position);
    if (area_way_used(kAreaWay_ltc) || area_way_used(kAreaWay_ltc_clipless) || area_way_used(kAreaWay_ltc_isotropic))
        return area_light_by_cosines(f, x, model, position, layer);
    return vec3_all(lit(0.0));
}

BN_KERNELS_END

#endif
