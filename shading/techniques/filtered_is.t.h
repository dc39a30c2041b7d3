// Filtered importance sampling of a Beckmann or a GGX lobe: see filtered_is.k.h.
#ifndef BN_FILTERED_IS_T_H
#define BN_FILTERED_IS_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/energy.k.h"
#include "shading/techniques/filtered_is.k.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

// Sums the grid's samples.
BN_FN real3 filtered_is_sum(frame_ref f, BN_IN(shaded_point) x, bool ggx)
{
    cube_desc cube = mip_env(f);
    // Find the texels per sample
    real3 o = eye_in_lobe(x);
    real size = to_real(int_lit(cube.size));
    real count = to_real(int_lit(the_frame(f).grid_count));
    real texels = size * size * lit(0.47746482927568601) / count; // 6 / (4 pi)
    real texel_term = lit(0.5) * k_log2(texels);
    // Set up the lobe
    real root2 = lit(1.4142135623730951);
    real alpha_u = x.lobe.sigma_u * root2;
    real alpha_v = x.lobe.sigma_v * root2;
    ggx_aniso_params of_ggx = ggx_aniso_params_of(alpha_u, alpha_v);
    beckmann_params of_beckmann = beckmann_params_of(alpha_u, alpha_v);
    // Start the sums
    cube_terms sum;
    cube_terms_begin(sum, cube, true);
    real weights = lit(0.0);
    real kept = lit(0.0);
    // Visit the grid's samples
    for (int i = 0; i < the_frame(f).grid_count; ++i) {
        // Take the sample's direction, weight and level
        real3 g = grid_sample(f, i);
        filtered_sample s;
        if (ggx)
            s = filtered_is_ggx(o, of_ggx, g.x, g.y, g.z, texel_term);
        else
            s = filtered_is_beckmann(o, of_beckmann, g.x, g.y, g.z, texel_term);
        // Add radiance times weight and Fresnel
        real3 wi = from_lobe(x.lobe, x.s.n, s.wi);
        real3 fresnel = reflectance_of(x.s, k_saturate(s.o_dot_h));
        real weight = above_horizon(x, wi, s.weight);
        cube_terms_add(sum, wi, s.lod, fresnel, weight);
        weights = weights + s.weight;
        kept = kept + weight;
    }
    // Correct the sum for tilt and energy
    real3 total = cube_terms_value(sum);
    real own = weights / count;
    if (x.has_surface_horizon &&
        lies_in_surface(f)) { // as if the lobe were untilted: x.energy.albedo_ratio has the loss of a tilted lobe below the horizon
        real mean_weight = kept / count;
        total = total * own / max(mean_weight, lit(1e-4));
    }
    if (the_frame(f).energy_compensation != 0) { // the albedo of these few samples, or of a Beckmann lobe, differs from the table's
        if (uses_substitute_lobe(f))
            own = own * x.energy.albedo_ratio;
        total = total * energy_compensation_of_albedo(x.s.f0, own) / x.energy.compensation;
    }
    // Take the mean; replace lobes without width by mirrors
    uniform_real scale = the_frame(f).box.scale / the_frame(f).specular.scale;
    real3 mean = total / count * splat(scale);
    return mirrors_apart(f, x, mean, lit(1.0));
}

BN_FN real3 filtered_is_specular(frame_ref f, BN_IN(shaded_point) x)
{
    return filtered_is_sum(f, x, false);
}

BN_FN real3 filtered_is_ggx_specular(frame_ref f, BN_IN(shaded_point) x)
{
    return filtered_is_sum(f, x, true);
}

BN_KERNELS_END

#endif
