// From a material at a visible point to the surface that lights shade: normal, lobe, reflectances, albedo.
#ifndef BN_SHADED_POINT_T_H
#define BN_SHADED_POINT_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/diffuse.k.h"
#include "shading/surface/energy.k.h"
#include "shading/surface/lobe_shape.t.h"
#include "shading/surface/material.t.h"
#include "shading/surface/placed_lobe.t.h"
#include "shading/surface/reflectance.t.h"
#include "shading/surface/refraction.t.h"
#include "shading/surface/surface.k.h"
#include "shading/surface/visible_point.k.h"

BN_KERNELS_BEGIN

struct shaded_point {
    surface s;
    aniso_lobe lobe;
    surface_frame surface_axes; // the geometry's
    bool turned;                // a normal map or a tilt turns s.n from surface_axes.n: nothing arrives from below the surface's horizon
    bool diffuse;               // s.diffuse may be above 0
    real brushed;               // the material's
    dfg_value dfg;
    real3 albedo;       // directional, of the lobe: for techniques of a split integral
    real phong_albedo;  // directional, of an Ashikhmin-Shirley lobe of the same widths, where there is a table of it; else -1
    int phong_set;      // MaterialRecord's
    real shown;         // directional albedo of a lobe that takes the usual one's place, over that of the usual one, upright; 1 otherwise
    dfg_value own_dfg;  // of a lobe that is compensated by its own albedo (has_own_gain); dfg otherwise
    dfg_value whole;    // own_dfg of the lobe that the material has before normals widen it: what a pixel reflects of all its facets
    real3 compensation; // energy compensation of the lobe; 1 without
    real3 gain;         // multiplies the specular lobe: energy compensation, what widening took from the lobe, what facets keep of it
    real3 dielectric_f0;
    real dielectric_f90;
    integer pixel_id;         // y * width + x, for random numbers
    bool refracts;            // it lets light through, and its technique follows that
    interface_inputs through; // then
};

BN_FN placed_lobe placed_lobe_at(frame_ref f, BN_IN(shaded_point) x)
{
    return placed_lobe_of(the_frame(f).lobe, x.lobe, x.s.n, x.s.v, x.surface_axes);
}

BN_FN rough_interface rough_interface_at(BN_IN(shaded_point) x)
{
    return rough_interface_of(x.through, x.lobe, x.s.n, x.s.v, x.surface_axes);
}

// The frame's lobe, or a clear coat's, which is round whatever that is, and its traits.
BN_FN int lobe_met(frame_ref f, bool coat)
{
    return coat ? lobe_that_has(kLobeOfRound) : the_frame(f).lobe;
}
BN_FN bool lobe_met_has(frame_ref f, bool coat, int trait)
{
    if (coat)
        return lobe_has(lobe_that_has(kLobeOfRound), trait);
    return (the_frame(f).lobe_traits & trait) != 0;
}

// Whether lobes may be tilted against the surface, and know where it is.
BN_FN bool lies_in_surface(frame_ref f)
{
    return (the_frame(f).lobe_traits & kLies_surface) != 0;
}

// Whether a material's lobes may lie otherwise than about the normal of their surface.
BN_FN bool leans(frame_ref f, material_ref m)
{
    bool upright = the_material(m).tilted == 0 && !texture_used(m, kNormalTex) && the_frame(f).lobe != the_frame(f).brdf;
    return lies_in_surface(f) && !upright;
}

// Whether the frame's lobes take the place of the usual one, of which the tables are: tilted or masked in another way.
BN_FN bool stands_in(frame_ref f)
{
    return (the_frame(f).lobe_traits & kLobeOfAll) == 0 && lobe_has(the_frame(f).brdf, kLobeOfAll);
}

// See shaded_point::shown. By the same samples of both, whose errors are alike: it goes to 1 with the tilt. So many that none of them is
// seen to go below the horizon as the tilt changes.
BN_FN real share_of_usual(frame_ref f, material_ref m, BN_IN(shaded_point) x)
{
    real least = lit(0.05);
    surface_frame upright;
    upright.n = x.s.n;
    upright.t = x.lobe.u_axis;
    upright.b = x.lobe.v_axis;
    real share = lit(1.0);
    if (leans(f, m)) {
        placed_lobe own = placed_lobe_of(the_frame(f).lobe, x.lobe, x.s.n, x.s.v, upright);
        share = placed_lobe_mean(placed_lobe_at(f, x), 55, 34) / max(placed_lobe_mean(own, 55, 34), least);
    }
    if (the_frame(f).masking != 0) {
        placed_lobe separable = placed_lobe_of(lobe_that_has(kSeparableOfAll), x.lobe, x.s.n, x.s.v, upright);
        placed_lobe usual = placed_lobe_of(lobe_that_has(kLobeOfAll), x.lobe, x.s.n, x.s.v, upright);
        share = share * placed_lobe_mean(separable, 55, 34) / max(placed_lobe_mean(usual, 55, 34), least);
    }
    real most = lit(1.0) / max(x.dfg.scale + x.dfg.bias, least); // no lobe gives back more than it gets
    return min(share, most);
}

// Directional albedo of the lobe: of its own two widths where they differ.
BN_FN dfg_value directional_albedo(frame_ref f, material_ref m, BN_IN(surface) s, BN_IN(aniso_lobe) lobe)
{
    if (the_frame(f).dfg_fit != 0)
        return dfg_fit(s.n_dot_v, s.roughness);
    if (the_material(m).anisotropic == 0)
        return dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, s.n_dot_v, s.roughness);
    dfg_value own;
    if (the_material(m).albedo_slice < 0)
        own = lobe_albedo_lookup(lobe_albedo_pairs(f), the_frame(f).lobe_albedo_size, lobe, s.n, s.v);
    else
        own = lobe_slice_lookup(lobe_slice_pairs(f), the_material(m).albedo_slice, lobe, s.n, s.v);
    if (the_material(m).brushed == 1.0f)
        return own;
    real part = splat(the_material(m).brushed);
    real still = lit(1.0) - part;
    dfg_value round = dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, s.n_dot_v, s.roughness);
    own.scale = round.scale * still + own.scale * part;
    own.bias = round.bias * still + own.bias * part;
    return own;
}

BN_FN real3 energy_gain(frame_ref f, real3 f0, dfg_value dfg)
{
    if (the_frame(f).energy_compensation == 0)
        return vec3_all(lit(1.0));
    return energy_compensation(f0, dfg);
}

// Of a material that lets light through: its interface takes a share of what the diffuse part has, and the gain of the whole is its own.
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

// The surface's frame under a normal map, as the frame or the material wants it turned.
BN_FN surface_frame frame_by_map(material_ref m, surface_frame axes, real3 map, real handedness)
{
    if (the_material(m).frame_map == kFrameQuaternion)
        return turned_frame(axes, map);
    if (the_material(m).frame_map == kFrameNormalOnly)
        return bent_frame(axes, map);
    return mapped_frame(axes, map, handedness);
}

// The frame of the geometry; a surface seen from behind shows its other side.
BN_FN real seen_handedness(BN_IN(visible_point) p)
{
    return select(p.front, p.tangent_sign, -p.tangent_sign);
}
BN_FN surface_frame seen_axes(BN_IN(visible_point) p)
{
    real3 normal = select(p.front, p.normal, -p.normal);
    return geometric_frame(normal, p.tangent, seen_handedness(p));
}

// The frame that the lobe lies in: that of the geometry turned by the normal map, and tilted.
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

// Whether lobes are compensated by an albedo of their own, as no table has it.
BN_FN bool has_own_gain(frame_ref f)
{
    return the_frame(f).energy_compensation != 0 && (the_frame(f).lobe_traits & (kLobeOfAll + kPunctualOnly)) == 0 && !stands_in(f);
}

// Round albedo of a roughness.
BN_FN dfg_value round_albedo(frame_ref f, real n_dot_v, real roughness)
{
    if (the_frame(f).dfg_fit != 0)
        return dfg_fit(n_dot_v, roughness);
    return dfg_lookup(dfg_pairs(f), the_frame(f).dfg_size, n_dot_v, roughness);
}

// Directional albedo of the material's own lobe, where normals have widened it: a pixel reflects what its facets reflect, and each of them
// has that lobe. A wider one masks and shadows itself and loses light. dfg: of the wide lobe, whose roughness s has.
BN_FN dfg_value albedo_before_widening(frame_ref f, BN_IN(surface) s, dfg_value dfg, real own_roughness)
{
    dfg_value wide = round_albedo(f, s.n_dot_v, s.roughness);
    dfg_value own = round_albedo(f, s.n_dot_v, own_roughness);
    mask wider = s.roughness > own_roughness;
    real scale = dfg.scale * (own.scale / max(wide.scale, lit(1e-3)));
    real bias = dfg.bias * (own.bias / max(wide.bias, lit(1e-3)));
    real room = max(lit(1.0) / max(scale + bias, lit(1e-3)), lit(0.0));
    dfg_value r;
    r.scale = select(wider, scale * min(room, lit(1.0)), dfg.scale);
    r.bias = select(wider, bias * min(room, lit(1.0)), dfg.bias);
    return r;
}

BN_FN real3 quotient_of(real3 a, real3 b)
{
    real least = lit(1e-4);
    return vec3_of(a.x / max(b.x, least), a.y / max(b.y, least), a.z / max(b.z, least));
}

// Place between the knots of what materials hold by the eye's cosine to the surface: MaterialRecord::kept.
BN_FN real kept_place(real cosine)
{
    real place = (cosine - lit(0.1)) * lit(3.3333333333333333);
    return min(max(place, lit(0.0)), lit(3.0));
}

// Weight of a knot there.
BN_FN real knot_weight(real place, int knot)
{
    return max(lit(1.0) - abs(place - to_real(int_lit(knot))), lit(0.0));
}

// Share of light that facets keep above the surface's horizon: see shading/bake/mip/kept_light.h. cosine: of the eye to the surface.
BN_FN real kept_light(material_ref m, real kept, real cosine)
{
    real place = kept_place(cosine);
    real loss = lit(0.0);
    for (int k = 0; k < kKeptKnots; ++k)
        loss = loss + splat(the_material(m).kept[k]) * knot_weight(place, k);
    return k_saturate(lit(1.0) - (lit(1.0) - kept) * loss);
}

// Multiplies x.gain by albedo(material's own lobe) / albedo(widened lobe). own_roughness: perceptual, of the former. At grazing angles
// facets hide each other, and the quotient fades to 1.
BN_FN void undo_widening(frame_ref f, real own_roughness, BN_INOUT(shaded_point) x)
{
    dfg_value met = x.whole;
    x.whole = albedo_before_widening(f, x.s, met, own_roughness);
    real3 grown = quotient_of(albedo_of(x.s, x.whole), albedo_of(x.s, met));
    if (the_frame(f).energy_compensation != 0)
        grown = grown * quotient_of(energy_compensation(x.s.f0, x.whole), energy_compensation(x.s.f0, met));
    real facing = k_saturate(min(x.s.n_dot_v, k_dot3(x.surface_axes.n, x.s.v)) * lit(8.0));
    x.gain = x.gain * (vec3_all(lit(1.0)) + (grown - vec3_all(lit(1.0))) * facing);
}

// Makes a lobe that stands for many facets reflect what they all reflect. Fills x.whole and multiplies x.gain.
BN_FN void keep_light(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_INOUT(shaded_point) x)
{
    x.whole = x.dfg;
    if (has_own_gain(f))
        x.whole = x.own_dfg;
    if (widens_lobes(m))
        undo_widening(f, own_alpha_lin(f, m, at), x);
    if (x.turned && the_material(m).keeps != 0)
        x.gain = x.gain * kept_light(m, at.kept, k_dot3(x.surface_axes.n, x.s.v));
}

// Fills x.
BN_FN void make_shaded_point(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_IN(lobe_shape) shape, BN_IN(visible_point) p,
                             integer pixel_id, BN_INOUT(shaded_point) x)
{
    x.pixel_id = pixel_id;
    real3 v = k_normalize3(-p.ray);
    x.surface_axes = seen_axes(p);
    surface_frame axes = lobe_axes(f, m, at, x.surface_axes, seen_handedness(p));
    x.turned = (texture_used(m, kNormalTex) && the_frame(f).horizon != 0) || leans(f, m);
    x.lobe = lobe_in_frame(m, shape, axes);
    x.diffuse = the_material(m).metallic < 1.0f || texture_used(m, kMetalRoughTex);
    x.dielectric_f0 = at.dielectric_f0;
    x.dielectric_f90 = at.dielectric_f90;
    x.s = metallic_roughness_surface(axes.n, v, at.base, at.metallic, shape.alpha_lin, at.dielectric_f0, at.dielectric_f90, at.occlusion);
    x.s.exact = the_frame(f).fresnel;
    if (x.s.exact != 0) {
        x.s.parts = fresnel_parts_of(f, m, at.base, at.metallic, at.dielectric_f0, at.dielectric_f90);
        x.s.f0 = exact_reflectance(x.s.parts, lit(1.0));
    }
    x.brushed = splat(the_material(m).brushed);
    x.dfg = directional_albedo(f, m, x.s, x.lobe);
    x.albedo = albedo_of(x.s, x.dfg);
    x.phong_albedo = lit(-1.0);
    x.phong_set = the_material(m).phong_set;
    dfg_value phong = x.dfg;
    if (the_material(m).phong_slice >= 0) {
        phong = phong_slice_lookup(lobe_slice_pairs(f), the_material(m).phong_slice, the_frame(f).lobe_albedo_size, x.lobe, x.s.n, x.s.v);
        x.phong_albedo = phong.scale + phong.bias;
    }
    x.gain = energy_gain(f, x.s.f0, x.dfg);
    x.shown = lit(1.0);
    x.own_dfg = x.dfg;
    if ((the_frame(f).lobe_traits & kPunctualOnly) != 0)
        x.gain = vec3_all(lit(1.0));
    else if ((the_frame(f).lobe_traits & kLobeOfAll) == 0) {
        bool compensated = the_frame(f).energy_compensation != 0;
        real albedo = lit(1.0);
        if (stands_in(f)) {
            if (compensated || (the_material(m).technique_traits & kSamplesLobe) == 0 || the_frame(f).area_light_count > 0)
                x.shown = share_of_usual(f, m, x);
            albedo = (x.dfg.scale + x.dfg.bias) * x.shown;
        } else if (compensated) {
            albedo = x.phong_albedo;
            if (the_material(m).phong_slice < 0 || !lobe_has(the_frame(f).lobe, kLobeOfPhong)) {
                lobe_energy own = placed_lobe_own_energy(placed_lobe_at(f, x));
                albedo = own.albedo;
                phong.bias = own.grazing;
            }
            x.own_dfg.bias = phong.bias;
            x.own_dfg.scale = albedo - phong.bias;
        }
        if (compensated)
            x.gain = energy_compensation_of_albedo(x.s.f0, min(albedo, lit(1.0)));
    }
    x.compensation = x.gain;
    keep_light(f, m, at, x);
    x.refracts = the_material(m).refracts != 0;
    if (x.refracts)
        make_interface(f, m, at, p.front, x);
}

// Of light at a cosine, what the diffuse part makes more or less of than Lambert's.
BN_FN real diffuse_lit(frame_ref f, real n_dot_l)
{
    if (the_frame(f).diffuse_model == 0)
        return lit(1.0);
    return phong_diffuse_lit(n_dot_l);
}

// The share of light that the dielectric's specular part lets through to the diffuse one, whatever the light: all that the lobe does not
// give back of light from everywhere. (Ashikhmin and Shirley's own, uncompensated: by f0, with phong_diffuse_lit() of the light.)
BN_FN real passed_to_diffuse(frame_ref f, BN_IN(shaded_point) x)
{
    if (the_frame(f).diffuse_model != 0 && the_frame(f).energy_compensation == 0 && !x.refracts) {
        real3 own = x.dielectric_f0;
        return phong_diffuse_seen(max(own.x, max(own.y, own.z)), x.s.n_dot_v);
    }
    real3 dielectric = dielectric_albedo_of(x.s, x.dielectric_f0, x.dielectric_f90, x.whole) * energy_gain(f, x.dielectric_f0, x.whole);
    real passed = lit(1.0) - max(dielectric.x, max(dielectric.y, dielectric.z));
    if (!x.refracts)
        return passed;
    // Glass reflects by Fresnel's equations, the table's lobe by Schlick's: a mirror's quotient turns one into the other. From within no
    // table has the albedo, and the mirror's stands for the lobe's.
    real3 r = dielectric_reflectance(x.dielectric_f0, x.dielectric_f90, x.through.parts.ior, x.s.n_dot_v);
    real mirrored = max(r.x, max(r.y, r.z));
    real3 schlick = fresnel_schlick(x.dielectric_f0, vec3_all(x.dielectric_f90), x.s.n_dot_v);
    real rough = (lit(1.0) - passed) / max(max(schlick.x, max(schlick.y, schlick.z)), lit(1e-4));
    real reflected = select(x.through.parts.ior >= lit(1.0), mirrored * rough, mirrored);
    return k_saturate(lit(1.0) - reflected);
}

// BRDF of the diffuse part, 1/sr; times diffuse_lit().
BN_FN real3 diffuse_brdf(frame_ref f, BN_IN(shaded_point) x)
{
    real share = passed_to_diffuse(f, x) * lit(0.31830988618379067);
    return x.s.diffuse * share;
}

BN_KERNELS_END

#endif
