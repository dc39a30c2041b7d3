// From a material at a visible point to the surface that lights shade: normal, lobe, reflectances, albedo.
#ifndef BN_SHADED_POINT_T_H
#define BN_SHADED_POINT_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/bsdf_lobe.t.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/diffuse.k.h"
#include "shading/surface/energy.k.h"
#include "shading/surface/lobe_shape.t.h"
#include "shading/surface/material.t.h"
#include "shading/surface/reflectance.t.h"
#include "shading/surface/refraction.t.h"
#include "shading/surface/surface.k.h"
#include "shading/surface/visible_point.k.h"

BN_KERNELS_BEGIN

struct shaded_point {
    surface s;
    aniso_lobe lobe;
    surface_frame geometric_axes; // the geometry's
    bool has_surface_horizon;     // a normal map or a tilt turns s.n from geometric_axes.n; the surface's horizon cuts off light
    bool diffuse;                 // s.diffuse may be above 0
    real anisotropy_blend;        // the material's
    dfg_value dfg;
    real3 albedo;       // the lobe's directional albedo, for techniques with a split integral
    real phong_albedo;  // directional albedo of an Ashikhmin-Shirley lobe with the same widths, from a table; -1: no table
    int phong_set;      // MaterialRecord's
    real albedo_ratio;  // albedo(frame's lobe) / albedo(default lobe, untilted); 1 for the default lobe
    dfg_value own_dfg;  // of a lobe compensated by its own albedo (has_own_gain); else dfg
    dfg_value whole;    // own_dfg of the material's lobe before normals widen it: the reflectance of all facets in a pixel
    real3 compensation; // the lobe's energy compensation; 1 without
    real3 gain;         // factor on the specular lobe: energy compensation, loss by widening, and light that facets keep
    real3 dielectric_f0;
    real dielectric_f90;
    integer pixel_id;         // y * width + x, for random numbers
    bool refracts;            // transmits light, and its technique follows transmitted light
    interface_inputs through; // for transmissive surfaces
};

// Returns the frame's lobe on the surface.
BN_FN bsdf_lobe bsdf_lobe_at(frame_ref f, BN_IN(shaded_point) x)
{
    return make_bsdf_lobe(the_frame(f).lobe, x.lobe, x.s.n, x.s.v, x.geometric_axes);
}

// Returns the transmissive surface's interface.
BN_FN rough_interface rough_interface_at(BN_IN(shaded_point) x)
{
    return rough_interface_of(x.through, x.lobe, x.s.n, x.s.v, x.geometric_axes);
}

// A layer of a material, as lights see it: its lobe's index in shading/models.def, and the lobe's traits.
struct lobe_layer {
    int lobe;
    int traits;
};

// Returns the material's own layer: the frame's lobe.
BN_FN lobe_layer base_layer(frame_ref f)
{
    lobe_layer r;
    r.lobe = the_frame(f).lobe;
    r.traits = the_frame(f).lobe_traits;
    return r;
}

// Returns a layer with a lobe of its own, whatever lobe the frame has. lobe: index in shading/models.def.
BN_FN lobe_layer layer_with_lobe(int lobe)
{
    lobe_layer r;
    r.lobe = lobe;
    r.traits = traits_of_model(lobe);
    return r;
}

BN_FN bool layer_has(lobe_layer layer, int traits)
{
    return (layer.traits & traits) != 0;
}

// Returns true where lobes lie in the surface's frame: they can tilt, and know the surface's horizon.
BN_FN bool lies_in_surface(frame_ref f)
{
    return (the_frame(f).lobe_traits & kLies_surface) != 0;
}

// Returns true where a material's lobes may tilt against the normal of their surface.
BN_FN bool can_tilt(frame_ref f, material_ref m)
{
    bool upright = the_material(m).tilted == 0 && !texture_used(m, kNormalTex) && the_frame(f).lobe != the_frame(f).brdf;
    return lies_in_surface(f) && !upright;
}

// Returns true where the frame's lobe replaces the default one, for tilts or separable masking. The tables hold the default
// lobe.
BN_FN bool uses_substitute_lobe(frame_ref f)
{
    return (the_frame(f).lobe_traits & kDefaultLobe) == 0 && lobe_has(the_frame(f).brdf, kDefaultLobe);
}

// Computes shaded_point::albedo_ratio. Uses the same samples for both lobes, so errors cancel and the ratio goes to 1 with the
// tilt. The number of samples hides single ones that sink below the horizon as the tilt changes.
BN_FN real default_albedo_ratio(frame_ref f, material_ref m, BN_IN(shaded_point) x)
{
    real least = lit(0.05);
    surface_frame upright;
    upright.n = x.s.n;
    upright.t = x.lobe.u_axis;
    upright.b = x.lobe.v_axis;
    real share = lit(1.0);
    // Compare the tilted with the untilted lobe
    if (can_tilt(f, m)) {
        bsdf_lobe own = make_bsdf_lobe(the_frame(f).lobe, x.lobe, x.s.n, x.s.v, upright);
        share = bsdf_lobe_albedo(bsdf_lobe_at(f, x), 55, 34) / max(bsdf_lobe_albedo(own, 55, 34), least);
    }
    // Compare separable with correlated masking
    if (the_frame(f).masking != 0) {
        bsdf_lobe separable = make_bsdf_lobe(lobe_that_has(kSeparableLobe), x.lobe, x.s.n, x.s.v, upright);
        bsdf_lobe correlated = make_bsdf_lobe(lobe_that_has(kDefaultLobe), x.lobe, x.s.n, x.s.v, upright);
        share = share * bsdf_lobe_albedo(separable, 55, 34) / max(bsdf_lobe_albedo(correlated, 55, 34), least);
    }
    real most = lit(1.0) / max(x.dfg.scale + x.dfg.bias, least); // no lobe reflects more light than it receives
    return min(share, most);
}

// Returns the lobe's directional albedo, for its own two widths where they differ.
BN_FN dfg_value directional_albedo(frame_ref f, material_ref m, BN_IN(surface) s, BN_IN(aniso_lobe) lobe)
{
    // Take round lobes from the fit or the table
    if (the_frame(f).dfg_fit != 0)
        return dfg_fit(s.n_dot_v, s.roughness);
    if (the_material(m).anisotropic == 0)
        return dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, s.n_dot_v, s.roughness);
    // Look up the albedo for two widths
    dfg_value own;
    if (the_material(m).albedo_slice < 0)
        own = lobe_albedo_lookup(lobe_albedo_pairs(f), the_frame(f).lobe_albedo_size, lobe, s.n, s.v);
    else
        own = lobe_slice_lookup(lobe_slice_pairs(f), the_material(m).albedo_slice, lobe, s.n, s.v);
    if (the_material(m).anisotropy_blend == 1.0f)
        return own;
    // Blend with the round lobe's albedo
    real part = splat(the_material(m).anisotropy_blend);
    real still = lit(1.0) - part;
    dfg_value round = dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, s.n_dot_v, s.roughness);
    own.scale = round.scale * still + own.scale * part;
    own.bias = round.bias * still + own.bias * part;
    return own;
}

// Returns the factor of energy compensation, or 1.
BN_FN real3 energy_gain(frame_ref f, real3 f0, dfg_value dfg)
{
    if (the_frame(f).energy_compensation == 0)
        return vec3_all(lit(1.0));
    return energy_compensation(f0, dfg);
}

// Makes the interface of a transmissive material: the interface takes a share of the diffuse part, and its own gain
// replaces x.gain.
BN_STAGE void make_interface(any_frame f, material_ref m, BN_IN(material_inputs) at, mask front, BN_INOUT(shaded_point) x)
{
    x.through.parts = fresnel_parts_of(f, m, at.base, at.metallic, at.dielectric_f0, at.dielectric_f90);
    x.through.parts.ior = index_of_far_side(splat(the_material(m).ior), front);
    x.through.tint = x.s.diffuse * at.transmission;
    x.s.diffuse = x.s.diffuse * (lit(1.0) - at.transmission);
    x.gain = vec3_all(lit(1.0));
    if (the_frame(f).energy_compensation != 0)
        x.gain = vec3_all(lit(1.0) / max(interface_albedo(rough_interface_at(x)), lit(0.05)));
}

// Returns the surface's frame under a normal map, turned by the method that the material's record names.
BN_FN surface_frame frame_by_map(material_ref m, surface_frame axes, real3 map, real handedness)
{
    if (the_material(m).frame_map == kFrameQuaternion)
        return turned_frame(axes, map);
    if (the_material(m).frame_map == kFrameNormalOnly)
        return bent_frame(axes, map);
    return mapped_frame(axes, map, handedness);
}

// Return the geometry's frame; a surface seen from behind shows its other side.
BN_FN real facing_handedness(BN_IN(visible_point) p)
{
    return select(p.front, p.tangent_sign, -p.tangent_sign);
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

// Returns true where lobes are compensated by their own albedo, which no table of the default lobe holds.
BN_FN bool has_own_gain(frame_ref f)
{
    return the_frame(f).energy_compensation != 0 && (the_frame(f).lobe_traits & (kDefaultLobe + kPunctualOnly)) == 0 &&
           !uses_substitute_lobe(f);
}

// Returns the albedo of a round lobe.
BN_FN dfg_value round_albedo(frame_ref f, real n_dot_v, real roughness)
{
    if (the_frame(f).dfg_fit != 0)
        return dfg_fit(n_dot_v, roughness);
    return dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, n_dot_v, roughness);
}

// Returns directional albedo of the material's own lobe where normals have widened the lobe. A pixel reflects what its
// facets reflect, and each facet has the narrow lobe; the wide lobe masks and shadows itself and loses light. dfg: the wide
// lobe's; s has its roughness.
BN_FN dfg_value albedo_before_widening(frame_ref f, BN_IN(surface) s, dfg_value dfg, real own_roughness)
{
    // Scale the albedo by the ratio of round lobes
    dfg_value wide = round_albedo(f, s.n_dot_v, s.roughness);
    dfg_value own = round_albedo(f, s.n_dot_v, own_roughness);
    mask wider = s.roughness > own_roughness;
    real scale = dfg.scale * (own.scale / max(wide.scale, lit(1e-3)));
    real bias = dfg.bias * (own.bias / max(wide.bias, lit(1e-3)));
    // Limit the sum to 1
    real room = max(lit(1.0) / max(scale + bias, lit(1e-3)), lit(0.0));
    dfg_value r;
    r.scale = select(wider, scale * min(room, lit(1.0)), dfg.scale);
    r.bias = select(wider, bias * min(room, lit(1.0)), dfg.bias);
    return r;
}

// Returns a / b by channel, with b at least 1e-4.
BN_FN real3 quotient_of(real3 a, real3 b)
{
    real least = lit(1e-4);
    return vec3_of(a.x / max(b.x, least), a.y / max(b.y, least), a.z / max(b.z, least));
}

// Returns the place between the knots of MaterialRecord::kept. cosine: of the eye to the surface.
BN_FN real kept_place(real cosine)
{
    real place = (cosine - lit(0.1)) * lit(3.3333333333333333);
    return min(max(place, lit(0.0)), lit(3.0));
}

// Returns a knot's weight at that place.
BN_FN real knot_weight(real place, int knot)
{
    return max(lit(1.0) - abs(place - to_real(int_lit(knot))), lit(0.0));
}

// Returns the share of light that facets keep above the surface's horizon: see shading/bake/mip/kept_light.h. cosine: of
// the eye to the surface.
BN_FN real kept_light(material_ref m, real kept, real cosine)
{
    real place = kept_place(cosine);
    real loss = lit(0.0);
    for (int k = 0; k < kKeptKnots; ++k)
        loss = loss + splat(the_material(m).kept[k]) * knot_weight(place, k);
    return k_saturate(lit(1.0) - (lit(1.0) - kept) * loss);
}

// Multiplies x.gain by albedo(material's own lobe) / albedo(widened lobe). own_roughness: perceptual, the own lobe's. At
// grazing angles facets hide each other, and the ratio fades to 1.
BN_FN void undo_widening(frame_ref f, real own_roughness, BN_INOUT(shaded_point) x)
{
    dfg_value met = x.whole;
    x.whole = albedo_before_widening(f, x.s, met, own_roughness);
    real3 grown = quotient_of(albedo_of(x.s, x.whole), albedo_of(x.s, met));
    if (the_frame(f).energy_compensation != 0)
        grown = grown * quotient_of(energy_compensation(x.s.f0, x.whole), energy_compensation(x.s.f0, met));
    real facing = k_saturate(min(x.s.n_dot_v, k_dot3(x.geometric_axes.n, x.s.v)) * lit(8.0));
    x.gain = x.gain * (vec3_all(lit(1.0)) + (grown - vec3_all(lit(1.0))) * facing);
}

// Makes a lobe that replaces many facets reflect as much as they do. Fills x.whole and multiplies x.gain.
BN_FN void keep_light(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_INOUT(shaded_point) x)
{
    x.whole = x.dfg;
    if (has_own_gain(f))
        x.whole = x.own_dfg;
    if (widens_lobes(m))
        undo_widening(f, own_alpha_lin(f, m, at), x);
    if (x.has_surface_horizon && the_material(m).keeps != 0)
        x.gain = x.gain * kept_light(m, at.kept, k_dot3(x.geometric_axes.n, x.s.v));
}

// Fills x.
BN_FN void make_shaded_point(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_IN(lobe_shape) shape, BN_IN(visible_point) p,
                             integer pixel_id, BN_INOUT(shaded_point) x)
{
    x.pixel_id = pixel_id;
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
    x.s = metallic_roughness_surface(axes.n, v, at.base, at.metallic, shape.alpha_lin, at.dielectric_f0, at.dielectric_f90, at.occlusion);
    // Use exact reflectances where the frame wants them
    x.s.exact = the_frame(f).fresnel;
    if (x.s.exact != 0) {
        x.s.parts = fresnel_parts_of(f, m, at.base, at.metallic, at.dielectric_f0, at.dielectric_f90);
        x.s.f0 = exact_reflectance(x.s.parts, lit(1.0));
    }
    x.anisotropy_blend = splat(the_material(m).anisotropy_blend);
    // Look up directional albedo
    x.dfg = directional_albedo(f, m, x.s, x.lobe);
    x.albedo = albedo_of(x.s, x.dfg);
    // Look up the Ashikhmin-Shirley lobe's own albedo
    x.phong_albedo = lit(-1.0);
    x.phong_set = the_material(m).phong_set;
    dfg_value phong = x.dfg;
    if (the_material(m).phong_slice >= 0) {
        phong = phong_slice_lookup(lobe_slice_pairs(f), the_material(m).phong_slice, the_frame(f).lobe_albedo_size, x.lobe, x.s.n, x.s.v);
        x.phong_albedo = phong.scale + phong.bias;
    }
    x.gain = energy_gain(f, x.s.f0, x.dfg);
    // Find the gain by energy compensation, and the albedo ratio of a substitute lobe
    x.albedo_ratio = lit(1.0);
    x.own_dfg = x.dfg;
    if ((the_frame(f).lobe_traits & kPunctualOnly) != 0)
        x.gain = vec3_all(lit(1.0));
    else if ((the_frame(f).lobe_traits & kDefaultLobe) == 0) {
        bool compensated = the_frame(f).energy_compensation != 0;
        real albedo = lit(1.0);
        // Scale the table's albedo, or compute the lobe's own
        if (uses_substitute_lobe(f)) {
            if (compensated || (the_material(m).technique_traits & kSamplesLobe) == 0 || the_frame(f).area_light_count > 0)
                x.albedo_ratio = default_albedo_ratio(f, m, x);
            albedo = (x.dfg.scale + x.dfg.bias) * x.albedo_ratio;
        } else if (compensated) {
            albedo = x.phong_albedo;
            if (the_material(m).phong_slice < 0 || !lobe_has(the_frame(f).lobe, kPhongLobe)) {
                lobe_energy own = bsdf_lobe_own_energy(bsdf_lobe_at(f, x));
                albedo = own.albedo;
                phong.bias = own.grazing;
            }
            x.own_dfg.bias = phong.bias;
            x.own_dfg.scale = albedo - phong.bias;
        }
        // Compensate by that albedo
        if (compensated)
            x.gain = energy_compensation_of_albedo(x.s.f0, min(albedo, lit(1.0)));
    }
    // Account for facets and for transmission
    x.compensation = x.gain;
    keep_light(f, m, at, x);
    x.refracts = the_material(m).refracts != 0;
    if (x.refracts)
        make_interface(f, m, at, p.front, x);
}

// Returns the diffuse part's ratio to Lambert's BRDF for light at a cosine.
BN_FN real diffuse_lit(frame_ref f, real n_dot_l)
{
    if (the_frame(f).diffuse_model == 0)
        return lit(1.0);
    return phong_diffuse_lit(n_dot_l);
}

// Returns the diffuse transmittance: the share of light that the dielectric's specular part lets through to the diffuse
// part, for any light. It is 1 minus the lobe's directional albedo. (The uncompensated diffuse part of Ashikhmin and
// Shirley uses f0 instead, with phong_diffuse_lit() for the light.)
BN_FN real diffuse_energy_share(frame_ref f, BN_IN(shaded_point) x)
{
    if (the_frame(f).diffuse_model != 0 && the_frame(f).energy_compensation == 0 && !x.refracts) {
        real3 own = x.dielectric_f0;
        return phong_diffuse_seen(max(own.x, max(own.y, own.z)), x.s.n_dot_v);
    }
    real3 dielectric = dielectric_albedo_of(x.s, x.dielectric_f0, x.dielectric_f90, x.whole) * energy_gain(f, x.dielectric_f0, x.whole);
    real passed = lit(1.0) - max(dielectric.x, max(dielectric.y, dielectric.z));
    if (!x.refracts)
        return passed;
    // Glass reflects by Fresnel's equations, the table's lobe by Schlick's approximation: scale by the ratio of both in a
    // mirror. No table has the albedo from inside, so a mirror's replaces it there.
    real3 r = dielectric_reflectance(x.dielectric_f0, x.dielectric_f90, x.through.parts.ior, x.s.n_dot_v);
    real mirrored = max(r.x, max(r.y, r.z));
    real3 schlick = fresnel_schlick(x.dielectric_f0, vec3_all(x.dielectric_f90), x.s.n_dot_v);
    real rough = (lit(1.0) - passed) / max(max(schlick.x, max(schlick.y, schlick.z)), lit(1e-4));
    real reflected = select(x.through.parts.ior >= lit(1.0), mirrored * rough, mirrored);
    return k_saturate(lit(1.0) - reflected);
}

// Returns the diffuse part's BRDF, 1/sr; multiply by diffuse_lit().
BN_FN real3 diffuse_brdf(frame_ref f, BN_IN(shaded_point) x)
{
    real share = diffuse_energy_share(f, x) * lit(0.31830988618379067);
    return x.s.diffuse * share;
}

BN_KERNELS_END

#endif
