// Monte Carlo over a lobe of any model (bsdf_lobe.t.h) or over a rough interface (refraction.t.h), by their own samples,
// with Fresnel per sample.
#ifndef BN_MC_T_H
#define BN_MC_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/bsdf_lobe.t.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

// A Hammersley set, rotated by a hash of the pixel.
struct mc_points {
    real shift_x, shift_y;
    uniform_real inv; // 1 over the number of points
};

BN_FN mc_points mc_points_of(frame_ref f, BN_IN(shaded_point) x)
{
    mc_points r;
    // Hash the pixel to a shift
    r.inv = 1.0f / float(x.samples);
    integer seed = k_hash_u32(x.pixel_id ^ int_lit(the_frame(f).seed));
    r.shift_x = k_unit_from_bits(seed);
    r.shift_y = k_unit_from_bits(k_hash_u32(seed));
    return r;
}

// Returns point i, shifted, in [0,1)^2.
BN_FN real2 mc_point(BN_IN(mc_points) points, int i)
{
    uniform_real column = (float(i) + 0.5f) * points.inv;
    real u = splat(column) + points.shift_x;
    real v = k_radical_inverse2(int_lit(i)) + points.shift_y;
    return vec2_of(u - floor(u), v - floor(v));
}

// Samples a lobe.
BN_FN real3 mc_of_lobe(frame_ref f, BN_IN(shaded_point) x, BN_IN(bsdf_lobe) lobe)
{
    bool samples_extracted_lights = !lobe_has(lobe.model, kNormals_ggx + kBroadLobe); // extracted.t.h leaves this lobe to samples
    // Choose the environment: with extracted lights where samples meet them
    cube_desc cube = prefiltered_env(f);
    uniform_real scale = 1.0f;
    if (samples_extracted_lights) {
        cube = full_env(f);
        scale = the_frame(f).whole.scale / the_frame(f).specular.scale;
    }
    // Sum radiance times weight and Fresnel
    mc_points points = mc_points_of(f, x);
    cube_terms sum;
    cube_terms_begin(sum, cube, false);
    for (int i = 0; i < x.samples; ++i) {
        bsdf_sample b = bsdf_lobe_sample(lobe, mc_point(points, i));
        real3 fresnel = reflectance_of(x.s, b.o_dot_h);
        cube_terms_add(sum, b.wi, lit(0.0), fresnel, above_horizon(x, b.wi, b.weight));
    }
    // Take the mean; replace lobes without width by mirrors
    real3 mean = cube_terms_value(sum) * splat(points.inv);
    if (samples_extracted_lights)
        mean = mean * splat(scale);
    if (lobe_has(lobe.model, kBroadLobe)) // has a least width
        return mean;
    return mirrors_apart(f, x, mean, bsdf_lobe_mirror_albedo(lobe));
}

// Samples one interface: each microfacet reflects and refracts the environment with its extracted lights.
BN_STAGE real3 mc_of_interface(any_frame f, BN_IN(shaded_point) x, BN_IN(rough_interface) g)
{
    cube_desc cube = full_env(f);
    mc_points points = mc_points_of(f, x);
    cube_terms sum;
    cube_terms_begin(sum, cube, false);
    for (int i = 0; i < x.samples; ++i) {
        // Sample a microfacet, and both directions
        ellipsoid_facet m = ellipsoid_facet_seen(g.p.shape, g.o, mc_point(points, i));
        bsdf_sample r = ellipsoid_facet_reflects(g.p.shape, m, g.o);
        bsdf_sample t = ellipsoid_facet_refracts(g.p.shape, m, g.o, g.p.eta);
        // Add both, weighted by Fresnel
        real3 reflected = interface_reflects(g.at, m.o_dot_m);
        real3 refracted = interface_passes(g.at, m.o_dot_m);
        cube_terms_add(sum, from_frame(g.axes, r.wi), lit(0.0), reflected, r.weight);
        cube_terms_add(sum, from_frame(g.axes, t.wi), lit(0.0), refracted, t.weight);
    }
    // Take the mean, in units of the prefiltered environment
    uniform_real scale = the_frame(f).whole.scale / the_frame(f).specular.scale;
    real3 mean = cube_terms_value(sum) * splat(points.inv);
    return mean * splat(scale);
}

BN_FN real3 mc_specular(frame_ref f, BN_IN(shaded_point) x)
{
    if (interface_is_sampled(x)) {
        // Sample each channel by its own index where they differ, by one text
        real3 light = vec3_all(lit(0.0));
        for (int c = 0; c < (x.transmission.disperses ? 3 : 1); ++c) {
            interface_inputs through = x.transmission.inputs;
            if (x.transmission.disperses)
                through = interface_of_channel(x.transmission.inputs, to_real(int_lit(c)));
            real3 own = mc_of_interface(f, x, rough_interface_of(through, x.lobe, x.s.n, x.s.v, x.geometric_axes));
            if (x.transmission.disperses)
                own = channel_alone(own, c);
            light = light + own;
        }
        return light;
    }
    if ((the_frame(f).lobe_traits & kPunctualOnly) != 0)
        return vec3_all(lit(0.0));
    return mc_of_lobe(f, x, bsdf_lobe_at(f, x));
}

BN_KERNELS_END

#endif
