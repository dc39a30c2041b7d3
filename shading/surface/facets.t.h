// Surfaces whose whole normal map lies below a pixel: a few groups of its normals replace the map
// (shading/bake/mip/facets.h), each a surface of its own with a round lobe.
#ifndef BN_FACETS_T_H
#define BN_FACETS_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/lobe_energy.t.h"
#include "shading/surface/lobe_shape.t.h"
#include "shading/surface/material.t.h"

BN_KERNELS_BEGIN

// Returns how far a pixel sees all facets of its material, [0,1]: 1 where a level's texel loses as much light as the whole
// map and its normal is the surface's.
BN_FN real facets_seen(material_ref m, BN_IN(material_inputs) at, BN_IN(shaded_point) x)
{
    // Compare the texel's loss with the whole map's
    real lost = (lit(1.0) - at.kept) / splat(the_material(m).facets_from);
    real share = k_saturate((lost - lit(0.7)) * lit(4.0));
    // Fade where the texel's normal tilts
    real level = k_saturate((k_dot3(x.s.n, x.geometric_axes.n) - lit(0.92)) * lit(20.0));
    return share * share * (lit(3.0) - lit(2.0) * share) * level;
}

struct facet_words { // MaterialRecord::facet
    real x, y, weight, spread;
};

BN_FN facet_words facet_words_of(material_ref m, int facet)
{
    facet_words r;
    r.x = splat(the_material(m).facet[4 * facet]);
    r.y = splat(the_material(m).facet[4 * facet + 1]);
    r.weight = splat(the_material(m).facet[4 * facet + 2]);
    r.spread = splat(the_material(m).facet[4 * facet + 3]);
    return r;
}

// Returns the material at a facet: the facet's normal, and the roughness below all levels.
BN_FN material_inputs facet_inputs(material_ref m, BN_IN(material_inputs) at, BN_IN(facet_words) words)
{
    material_inputs r = at;
    real nz2 = lit(1.0) - (words.x * words.x + words.y * words.y);
    r.normal_map = vec3_of(words.x, words.y, sqrt(max(nz2, lit(0.0))));
    r.kept = lit(1.0);
    if (the_material(m).level_gain < 0.0f)
        r.own_roughness = k_saturate(at.roughness);
    return r;
}

// Returns a facet's lobe: the material's own, widened by the spread of its group's normals. at: facet_inputs().
BN_FN lobe_shape facet_shape(BN_IN(material_inputs) at, BN_IN(facet_words) words)
{
    real own2 = at.own_roughness * at.own_roughness;
    real alpha2 = own2 * own2 + words.spread;
    real alpha = min(sqrt(alpha2), lit(1.0));
    lobe_shape r;
    r.sigma_u = alpha * lit(0.70710678118654752);
    r.sigma_v = r.sigma_u;
    r.u = vec2_of(lit(1.0), lit(0.0));
    r.roughness = sqrt(alpha);
    return r;
}

struct facet_light {
    real map_over_groups; // share of light that facets keep above the surface's horizon, over the share that their groups keep
    real groups;          // share that the groups keep
};

// Interpolates the facets' shares of light. cosine: of the eye to the surface.
BN_FN facet_light facet_light_of(material_ref m, real cosine)
{
    real place = kept_place(cosine);
    facet_light r;
    r.map_over_groups = lit(0.0);
    r.groups = lit(0.0);
    for (int k = 0; k < kKeptKnots; ++k) {
        real weight = knot_weight(place, k);
        r.map_over_groups = r.map_over_groups + splat(the_material(m).facets_kept[k]) * weight;
        r.groups = r.groups + splat(the_material(m).groups_kept[k]) * weight;
    }
    return r;
}

// Scales x.energy.gain so that facets reflect as much as all normals of the map. at: facet_inputs(); chosen: 1, or 0 in lanes
// without facets.
BN_FN void keep_light_of_facets(frame_ref f, material_ref m, BN_IN(material_inputs) at, real chosen, BN_INOUT(shaded_point) x)
{
    // Undo the widening by the group's spread
    if (!widens_lobes(m)) {
        dfg_value whole = x.energy.whole;
        real3 gain = x.energy.gain;
        undo_widening(f, at.own_roughness, x);
        x.energy.whole.scale = whole.scale + (x.energy.whole.scale - whole.scale) * chosen;
        x.energy.whole.bias = whole.bias + (x.energy.whole.bias - whole.bias) * chosen;
        x.energy.gain = gain + (x.energy.gain - gain) * chosen;
    }
    // Keep the map's share of light above the horizon
    if (!x.has_surface_horizon)
        return;
    facet_light light = facet_light_of(m, k_dot3(x.geometric_axes.n, x.s.v));
    x.energy.gain = x.energy.gain * (lit(1.0) + (light.map_over_groups - lit(1.0)) * chosen);
}

BN_KERNELS_END

#endif
