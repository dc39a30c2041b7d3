// Directional albedos of a lobe, and its factors: energy compensation, loss by widening, light that facets keep.
#ifndef BN_LOBE_ENERGY_T_H
#define BN_LOBE_ENERGY_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/bsdf_lobe.t.h"
#include "shading/surface/dfg.k.h"
#include "shading/surface/energy.k.h"
#include "shading/surface/lobe_shape.t.h"
#include "shading/surface/material_inputs.t.h"
#include "shading/surface/reflectance.t.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

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
    real most = lit(1.0) / max(x.energy.dfg.scale + x.energy.dfg.bias, least); // no lobe reflects more light than it receives
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

// Returns true where lobes are compensated by their own albedo, which no table of the default lobe holds. Fibres absorb the light that a
// broad lobe does not reflect.
BN_FN bool has_own_gain(frame_ref f)
{
    return the_frame(f).energy_compensation != 0 && (the_frame(f).lobe_traits & (kDefaultLobe + kPunctualOnly + kBroadLobe)) == 0 &&
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

// Multiplies x.energy.gain by albedo(material's own lobe) / albedo(widened lobe). own_roughness: perceptual, the own lobe's. At
// grazing angles facets hide each other, and the ratio fades to 1.
BN_FN void undo_widening(frame_ref f, real own_roughness, BN_INOUT(shaded_point) x)
{
    dfg_value met = x.energy.whole;
    x.energy.whole = albedo_before_widening(f, x.s, met, own_roughness);
    real3 grown = quotient_of(albedo_of(x.s, x.energy.whole), albedo_of(x.s, met));
    if (the_frame(f).energy_compensation != 0)
        grown = grown * quotient_of(energy_compensation(x.s.f0, x.energy.whole), energy_compensation(x.s.f0, met));
    real facing = k_saturate(min(x.s.n_dot_v, k_dot3(x.geometric_axes.n, x.s.v)) * lit(8.0));
    x.energy.gain = x.energy.gain * (vec3_all(lit(1.0)) + (grown - vec3_all(lit(1.0))) * facing);
}

// Makes a lobe that replaces many facets reflect as much as they do. Fills x.energy.whole and multiplies x.energy.gain.
BN_FN void keep_light(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_INOUT(shaded_point) x)
{
    x.energy.whole = x.energy.dfg;
    if (has_own_gain(f))
        x.energy.whole = x.energy.own_dfg;
    if (widens_lobes(m))
        undo_widening(f, own_roughness(f, m, at), x);
    if (x.has_surface_horizon && the_material(m).keeps != 0)
        x.energy.gain = x.energy.gain * kept_light(m, at.kept, k_dot3(x.geometric_axes.n, x.s.v));
}

// Fills x.energy. x holds the surface, its lobe and reflectances.
BN_FN void find_energy(frame_ref f, material_ref m, BN_IN(material_inputs) at, BN_INOUT(shaded_point) x)
{
    // Look up directional albedo
    x.energy.dfg = directional_albedo(f, m, x.s, x.lobe);
    x.energy.albedo = albedo_of(x.s, x.energy.dfg);
    // Look up the Ashikhmin-Shirley lobe's own albedo
    x.energy.phong_albedo = lit(-1.0);
    x.energy.phong_set = the_material(m).phong_set;
    dfg_value phong = x.energy.dfg;
    if (the_material(m).phong_slice >= 0) {
        phong = phong_slice_lookup(lobe_slice_pairs(f), the_material(m).phong_slice, the_frame(f).lobe_albedo_size, x.lobe, x.s.n, x.s.v);
        x.energy.phong_albedo = phong.scale + phong.bias;
    }
    x.energy.gain = energy_gain(f, x.s.f0, x.energy.dfg);
    // Find the gain by energy compensation, and the albedo ratio of a substitute lobe
    x.energy.albedo_ratio = lit(1.0);
    x.energy.own_dfg = x.energy.dfg;
    if ((the_frame(f).lobe_traits & (kPunctualOnly + kBroadLobe)) != 0)
        x.energy.gain = vec3_all(lit(1.0));
    else if ((the_frame(f).lobe_traits & kDefaultLobe) == 0) {
        bool compensated = the_frame(f).energy_compensation != 0;
        real albedo = lit(1.0);
        // Scale the table's albedo, or compute the lobe's own
        if (uses_substitute_lobe(f)) {
            if (compensated || (the_material(m).technique_traits & kSamplesLobe) == 0 || the_frame(f).area_light_count > 0)
                x.energy.albedo_ratio = default_albedo_ratio(f, m, x);
            albedo = (x.energy.dfg.scale + x.energy.dfg.bias) * x.energy.albedo_ratio;
        } else if (compensated) {
            albedo = x.energy.phong_albedo;
            if (the_material(m).phong_slice < 0 || !lobe_has(the_frame(f).lobe, kPhongLobe)) {
                lobe_energy own = bsdf_lobe_own_energy(bsdf_lobe_at(f, x));
                albedo = own.albedo;
                phong.bias = own.grazing;
            }
            x.energy.own_dfg.bias = phong.bias;
            x.energy.own_dfg.scale = albedo - phong.bias;
        }
        // Compensate by that albedo
        if (compensated)
            x.energy.gain = energy_compensation_of_albedo(x.s.f0, min(albedo, lit(1.0)));
    }
    // Account for facets and for transmission
    x.energy.compensation = x.energy.gain;
    keep_light(f, m, at, x);
}

BN_KERNELS_END

#endif
