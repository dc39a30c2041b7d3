// A material at a visible point: its factors times its textures.
#ifndef BN_MATERIAL_T_H
#define BN_MATERIAL_T_H

#include "shading/inputs/stage.h"
#include "shading/kernels/visible_point.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/material_inputs.t.h"
#define BN_COATING_TEXTS
#include "shading/coatings.def"

BN_KERNELS_BEGIN

// Returns base colour and alpha.
BN_FN real4 base_color_of(material_ref m, BN_IN(texture_fetches) t, BN_IN(visible_point) p)
{
    // Multiply the factors by the texture and the vertex colour
    real3 color = splat3(the_material(m).base_color);
    real alpha = splat(the_material(m).base_color[3]);
    if (texture_used(m, kBaseColorTex)) {
        real4 base = texel_of(t, kBaseColorTex);
        color = color * rgb_of(base);
        alpha = alpha * base.w;
    }
    if (the_material(m).uses_color != 0) {
        color = color * rgb_of(p.color);
        alpha = alpha * p.color.w;
    }
    return vec4_of(color.x, color.y, color.z, alpha);
}

// Applies the vertex colour to the inputs of a material without textures.
BN_FN void colour_inputs(material_ref m, BN_IN(visible_point) p, BN_INOUT(material_inputs) r)
{
    if (the_material(m).uses_color == 0)
        return;
    r.base = splat3(the_material(m).base_color) * rgb_of(p.color);
    r.alpha = splat(the_material(m).base_color[3]) * p.color.w;
}

// Returns the normal map's normal, any length.
BN_FN real3 normal_of_texel(material_ref m, real4 texel)
{
    return scaled_normal(texel, splat(the_material(m).normal_scale));
}

// Returns reflectance times a mip level's albedo gain; the gain raises no value beyond 1.
BN_FN real3 gained_reflectance(real3 reflectance, real gain)
{
    return min(reflectance * gain, max(reflectance, vec3_all(lit(1.0))));
}

// Returns the same alpha as fetch_material().
BN_FN real fetch_alpha(frame_ref f, material_ref m, BN_IN(visible_point) p)
{
    texture_fetches t = textures_at(f, m, p);
    return base_color_of(m, t, p).w;
}

// Fills the inputs of a thin film.
BN_FN void film_inputs(material_ref m, BN_IN(texture_fetches) t, BN_INOUT(material_inputs) r)
{
    r.film = splat(the_material(m).iridescence);
    if (texture_used(m, kFilmTex))
        r.film = r.film * texel_of(t, kFilmTex).x;
    r.film_thickness = splat(the_material(m).iridescence_thickness);
    if (texture_used(m, kFilmThicknessTex)) {
        real least = splat(the_material(m).iridescence_thickness_least);
        r.film_thickness = least + (r.film_thickness - least) * texel_of(t, kFilmThicknessTex).y;
    }
}

// Evaluates all inputs of the material at p.
BN_FN material_inputs fetch_material(frame_ref f, material_ref m, BN_IN(visible_point) p)
{
    texture_fetches t = textures_at(f, m, p);
    material_inputs r;
    // Base colour, metalness and roughness
    real4 base_color = base_color_of(m, t, p);
    r.base = rgb_of(base_color);
    r.alpha = base_color.w;
    r.metallic = splat(the_material(m).metallic);
    r.roughness = splat(the_material(m).roughness);
    // Multiply by the metallic-roughness texture
    if (texture_used(m, kMetalRoughTex)) {
        real4 factors = texel_of(t, kMetalRoughTex);
        if (the_material(m).roughness_fixed == 0)
            r.roughness = r.roughness * factors.y;
        r.metallic = r.metallic * factors.z;
    }
    // Normal, and the share of light that facets keep
    r.normal_map = vec3_of(lit(0.0), lit(0.0), lit(1.0));
    r.kept = lit(1.0);
    if (texture_used(m, kNormalTex)) {
        real4 normal = texel_of(t, kNormalTex);
        r.normal_map = normal_of_texel(m, normal);
        if (the_material(m).keeps != 0)
            r.kept = normal.w;
    }
    // Occlusion and emission
    r.occlusion = lit(1.0);
    if (texture_used(m, kOcclusionTex))
        r.occlusion = lit(1.0) + splat(the_material(m).occlusion_strength) * (texel_of(t, kOcclusionTex).x - lit(1.0));
    r.emissive = splat3(the_material(m).emissive);
    if (texture_used(m, kEmissiveTex))
        r.emissive = r.emissive * rgb_of(texel_of(t, kEmissiveTex));
    // Reflectance of the dielectric part
    r.dielectric_f0 = splat3(the_material(m).dielectric_f0);
    r.dielectric_f90 = splat(the_material(m).dielectric_f90);
    if (texture_used(m, kSpecularTex)) {
        real weight = texel_of(t, kSpecularTex).w;
        r.dielectric_f0 = r.dielectric_f0 * weight;
        r.dielectric_f90 = r.dielectric_f90 * weight;
    }
    if (texture_used(m, kSpecularColorTex))
        r.dielectric_f0 = r.dielectric_f0 * rgb_of(texel_of(t, kSpecularColorTex));
    // Direction tensors
    r.tensor2 = vec3_of(lit(1.0), lit(0.0), lit(0.0));
    r.tensor4 = r.tensor2;
    r.slope = vec2_all(lit(0.0));
    r.slope_moments = vec3_all(lit(0.0));
    r.own_roughness = lit(1.0);
    // Fetch the tensors
    if (texture_used(m, kTensor2Tex)) { // sums of two halves: one half alone bends thin lobes
        real4 two = texel_of(t, kTensor2Tex) + texel_of(t, kTensor2RestTex);
        real4 four = texel_of(t, kTensor4Tex) + texel_of(t, kTensor4RestTex);
        r.tensor2 = rgb_of(two);
        r.tensor4 = rgb_of(four);
        // Decode the slope moments of a mip level
        if (the_material(m).moments != kNoMoments) { // see shading/bake/mip/slopes.h
            r.slope = vec2_of(four.x, four.y) * splat(1.0f / kSlopeScale);
            r.slope_moments = vec3_of(two.w, four.z, four.w) * splat(1.0f / kMomentScale);
            r.tensor4 = r.tensor2 * (two.x + two.y); // as for a constant strength
            // Take normal, roughness and gain from the level; its moments replace the tensors
            if (the_material(m).level_gain >= 0.0f) { // one half alone turns narrow lobes visibly
                r.normal_map = vec3_of(r.slope.x, r.slope.y, two.y);
                r.slope = r.slope * splat(the_material(m).level_gain);
                r.own_roughness = two.z;
                r.base = gained_reflectance(r.base, two.x);
                r.dielectric_f0 = gained_reflectance(r.dielectric_f0, two.x);
                r.tensor2 = vec3_of(lit(1.0), lit(0.0), lit(0.0));
                r.tensor4 = r.tensor2;
            }
        }
    }
    // Transmission
    r.transmission = splat(the_material(m).transmission);
    if (texture_used(m, kTransmissionTex))
        r.transmission = r.transmission * texel_of(t, kTransmissionTex).x;
    // Thin film
    r.film = lit(0.0);
    r.film_thickness = lit(0.0);
    if (the_material(m).film != 0)
        film_inputs(m, t, r);
        // Coatings
#define BN_COATING(id, at, strength, lobe) id##_inputs(m, t, r);
#include "shading/coatings.def"
    return r;
}

// Returns the light that the material emits itself; the whole result for an unlit material.
BN_FN real3 own_light(material_ref m, BN_IN(material_inputs) at)
{
    if (the_material(m).unlit != 0)
        return at.base;
    return at.emissive;
}

BN_KERNELS_END

#endif
