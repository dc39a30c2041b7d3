// All light from a fragment towards the eye, from a material's inputs at a visible point.
#ifndef BN_FRAGMENT_LIGHT_T_H
#define BN_FRAGMENT_LIGHT_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/lang/techniques.h"
#include "shading/lights/area.t.h"
#include "shading/lights/broad.t.h"
#include "shading/lights/environment.t.h"
#include "shading/lights/extracted.t.h"
#include "shading/lights/punctual.t.h"
#include "shading/lights/transmitted.t.h"
#include "shading/surface/coating_point.t.h"
#include "shading/surface/facets.t.h"
#include "shading/surface/make_shaded_point.t.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/techniques/lobe_line.t.h"
#include "shading/techniques/mc.t.h"
#include "shading/techniques/shared_samples.k.h"
#include "shading/techniques/split_isotropic.t.h"

BN_KERNELS_BEGIN

// Returns reflected light from extracted lights. lobe: the lobe for lights, its index in shading/models.def.
BN_STAGE real3 light_of_sky(any_frame f, BN_IN(shaded_point) x, int lobe)
{
    return light_from_extracted_lights(f, x, lobe, base_layer(f));
}

// Returns reflected light from punctual lights.
BN_STAGE real3 light_of_lamps(any_frame f, BN_IN(shaded_point) x, int lobe, BN_IN(real3) position)
{
    return light_from_punctual(f, x, lobe, position);
}

// Returns reflected light from area lights.
BN_STAGE real3 light_of_area_lights(any_frame f, BN_IN(shaded_point) x, int lobe, BN_IN(real3) position)
{
    return light_from_area(f, x, lobe, position, base_layer(f));
}

struct coating_light {
    real passed; // transmittance for the layers below, their emission included
    real3 gloss; // the coating's own light
};

// Shades a coating. albedo: of its lobe; lobe: its index in shading/models.def. samples, traits: the technique's. A technique that samples
// lobes samples the coating's too; lobe_line takes its environment light from a line of samples, others from one prefiltered fetch. Broad
// lobes have lights of their own (broad.t.h).
BN_FN coating_light light_of_coating(frame_ref f, BN_IN(coating) layer, BN_IN(dfg_value) albedo, int lobe, BN_IN(material_inputs) at,
                                     BN_IN(surface_frame) axes, BN_IN(visible_point) p, integer pixel_id, int samples, int traits)
{
    shaded_point c;
    c.pixel_id = pixel_id;
    c.samples = samples;
    make_coating_point(layer, albedo, axes, k_normalize3(-p.ray), at.occlusion, layer.has_surface_horizon, c);
    bool broad = lobe_has(lobe, kBroadLobe);
    // Add environment light
    real3 light = vec3_all(lit(0.0));
    if ((traits & kSamplesLobe) != 0)
        light = environment_light(f, c, kSamplesLobe + kTestsHorizon,
                                  mc_of_lobe(f, c, make_bsdf_lobe(lobe, c.lobe, c.s.n, c.s.v, c.geometric_axes)));
    else if (broad)
        light = environment_light(f, c, kSamplesLobe + kTestsHorizon, broad_specular(f, c)); // fades tell of mirror directions
    else if ((traits & kRoundAlone) != 0)
        light = environment_light(f, c, kSamplesLobe, lobe_line_specular(f, c));
    else
        light = environment_light(f, c, kSamplesLobe, split_isotropic_specular(f, c));
    // Add extracted lights, lamps and area lights
    if (the_frame(f).extracted_light_count > 0)
        light = light + light_from_extracted_lights(f, c, lobe, layer_with_lobe(lobe));
    if (the_frame(f).light_count > 0)
        light = light + light_from_punctual(f, c, lobe, p.position);
    if (the_frame(f).area_light_count > 0) {
        bool cosines = area_way_used(kAreaWay_ltc) || area_way_used(kAreaWay_ltc_clipless) || area_way_used(kAreaWay_ltc_isotropic);
        if (broad && cosines && the_frame(f).area_way != kAreaWay_mc)
            light = light + broad_light_of_areas(f, c, p.position);
        else
            light = light + light_from_area(f, c, lobe, p.position, layer_with_lobe(lobe));
    }
    // Return the coating's light and transmittance
    coating_light r;
    r.passed = lit(1.0) - layer.share;
    r.gloss = light;
    return r;
}

// Define light_of_<id>() for each coating.
#define BN_COATING(id, at_bit, strength, lobe)                                                                                             \
    BN_STAGE coating_light light_of_##id(any_frame f, any_material m, BN_IN(material_inputs) at, BN_IN(visible_point) p, integer pixel_id, \
                                         int traits)                                                                                       \
    {                                                                                                                                      \
        surface_frame axes = facing_geometric_axes(p);                                                                                     \
        real3 v = k_normalize3(-p.ray);                                                                                                    \
        coating layer = id##_coating(f, m, at, axes, v, facing_handedness(p));                                                             \
        dfg_value albedo = id##_albedo(f, layer, coating_n_dot_v(layer, v));                                                               \
        return light_of_coating(f, layer, albedo, kLobe_##lobe, at, axes, p, pixel_id, the_material(m).samples, traits);                   \
    }
#include "shading/coatings.def"

// Puts a coating over r. shares: r has a shared part.
BN_FN shared_sample_record under_coating(shared_sample_record r, BN_IN(coating_light) over, bool shares)
{
    if (shares)
        r.factor = r.factor * over.passed;
    r.rest = r.rest * over.passed + over.gloss;
    return r;
}

// Estimates the share of a round facet's light from above the surface's horizon. The share is a half where the eye's mirror
// direction lies in the horizon, and grows with height over the lobe's slopes. Facets seen at grazing angles reflect from
// above that direction.
BN_FN real facet_share(BN_IN(shaded_point) x)
{
    if (!x.has_surface_horizon)
        return lit(1.0);
    real alpha = x.s.roughness * x.s.roughness;
    real rest = lit(1.0) - x.s.n_dot_v;
    real3 mirrored = x.s.n * (lit(2.0) * k_dot3(x.s.n, x.s.v)) - x.s.v;
    real high = k_dot3(x.geometric_axes.n, mirrored) * lit(0.5) + alpha * (lit(2.0) * rest * rest);
    real half_share = high * lit(0.5) / sqrt(max(high * high + alpha * alpha, lit(1e-12)));
    return lit(0.5) + half_share;
}

// Returns one prefiltered fetch of a round facet's light. The part of its lobe above the surface's horizon has a higher mean direction
// than the whole lobe, which is lifted as facet_share() falls.
BN_FN real3 facet_fetch(frame_ref f, BN_IN(shaded_point) x)
{
    if (!x.has_surface_horizon)
        return split_isotropic_specular(f, x);
    real alpha = x.s.roughness * x.s.roughness;
    real3 mirrored = x.s.n * (lit(2.0) * k_dot3(x.s.n, x.s.v)) - x.s.v;
    real high = k_dot3(x.geometric_axes.n, mirrored);
    real3 lifted = mirrored + x.geometric_axes.n * (lit(0.5) * (sqrt(high * high + alpha * alpha) - high));
    cube_desc cube = prefiltered_env(f);
    real lod = x.s.roughness * to_real(int_lit(cube.levels - 1));
    return cube_sample(cube, lifted, lod) * x.energy.albedo;
}

// Adds extracted lights, lamps and area lights to `light`. position: of the surface, world space.
BN_FN real3 plus_lights(frame_ref f, material_ref m, BN_IN(shaded_point) x, real3 position, real3 light)
{
    if (the_frame(f).extracted_light_count > 0)
        light = light + light_of_sky(f, x, the_material(m).lights_lobe);
    if (the_frame(f).light_count > 0)
        light = light + light_of_lamps(f, x, the_material(m).lights_lobe, position);
    if (the_frame(f).area_light_count > 0)
        light = light + light_of_area_lights(f, x, the_material(m).lights_lobe, position);
    return light;
}

// Shades a surface whose facets are all smaller than a pixel: shades each group of facets with a round lobe. Techniques
// that sample lobes sample these lobes. The others take one prefiltered fetch each, weighted by facet_share(); the mean is
// scaled to the light that the groups keep.
BN_STAGE real3 light_of_facets(any_frame f, any_material m, BN_IN(material_inputs) at, BN_IN(visible_point) p, integer pixel_id, int traits)
{
    bool samples = (traits & kSamplesLobe) != 0;
    real3 sum = vec3_all(lit(0.0));
    real3 fetched = vec3_all(lit(0.0));
    real shares = lit(0.0);
    real groups = lit(1.0);
    for (int k = 0; k < the_material(m).facets; ++k) {
        // Make a point for the group
        facet_words words = facet_words_of(m, k);
        material_inputs facet = facet_inputs(m, at, words);
        lobe_shape shape = facet_shape(facet, words);
        shaded_point x;
        make_shaded_point(f, m, facet, shape, p, pixel_id, x);
        keep_light_of_facets(f, m, facet, lit(1.0), x);
        real3 specular = vec3_all(lit(0.0)); // stays 0 for a lobe that only punctual lights meet
        // Find its environment light, by samples or by a fetch
        bool met = (the_frame(f).lobe_traits & kPunctualOnly) == 0;
        if (met && samples)
            specular = mc_of_lobe(f, x, bsdf_lobe_at(f, x));
        // Weight the fetch by its share above the horizon
        if (met && !samples) {
            real share = words.weight * facet_share(x);
            shares = shares + share;
            fetched = fetched + facet_fetch(f, x) * x.energy.gain * (share * x.s.occlusion);
            if (x.has_surface_horizon)
                groups = facet_light_of(m, k_dot3(x.geometric_axes.n, x.s.v)).groups;
        }
        // Add the lights, weighted by the group's share of the map
        real3 light = environment_light(f, x, kSamplesLobe + kTestsHorizon, specular);
        light = plus_lights(f, m, x, p.position, light);
        sum = sum + light * words.weight;
    }
    // Scale the fetches to the light that the groups keep
    real scale = groups / max(shares, lit(1e-3));
    return sum + fetched * (scale * splat(the_frame(f).specular.scale));
}

// Shades a fragment. shape: lobe_shape_at(f, m, at, p). px, py: pixel. shares: the technique shares samples, and fragments
// can read their neighbours; shared_sample_mean then makes the colour from all their samples.
BN_FN shared_sample_record light_of_fragment(frame_ref f, material_ref m, technique_ref t, BN_IN(material_inputs) at,
                                             BN_IN(lobe_shape) shape, BN_IN(visible_point) p, integer px, integer py, bool shares)
{
    // Take the material's own emission
    real3 light = own_light(m, at);
    if (the_material(m).unlit != 0)
        return unshared_record(light);
    // Make the shaded point
    shaded_point x;
    integer across = px + int_lit(the_frame(f).left);
    integer down = py + int_lit(the_frame(f).top);
    make_shaded_point(f, m, at, shape, p, down * int_lit(the_frame(f).picture_width) + across, x);
    // Add environment light and lights
    int traits = technique_traits(m, t);
    if (!shares)
        light = environment_light(f, x, traits, technique_specular(f, t, x)) + light;
    if (transmission_used() && the_material(m).refracts != 0 && (traits & kSamplesInterface) == 0)
        light = light + transmitted_light(f, m, x, p.position);
    light = plus_lights(f, m, x, p.position, light);
    // Keep the shared part apart
    shared_sample_record r;
    if (shares) {
        x.normal_dx = p.normal_dx;
        x.normal_dy = p.normal_dy;
        r = shared_light(f, x, traits, technique_shared(f, t, x, quad_offset(px & int_lit(1), py & int_lit(1))), light);
    } else
        r = unshared_record(light);
    // Blend to facets far away
    if (texture_used(m, kNormalTex) && the_material(m).facets > 0) {
        real far = facets_seen(m, at, x);
        // Shade the facets only where a lane sees them
        if (any_lane(far > lit(0.0))) {
            real3 facets = own_light(m, at) + light_of_facets(f, m, at, p, x.pixel_id, traits);
            if (shares)
                r.factor = r.factor * (lit(1.0) - far);
            r.rest = r.rest + (facets - r.rest) * far;
        }
    }
    // Put the coatings over it
#define BN_COATING(id, bit, strength, lobe)                                                                                                \
    if (coating_used(bit) && has_coating(m, bit))                                                                                          \
        r = under_coating(r, light_of_##id(f, m, at, p, x.pixel_id, traits), shares);
#include "shading/coatings.def"
    return r;
}

BN_KERNELS_END

#endif
