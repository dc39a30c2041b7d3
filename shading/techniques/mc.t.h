// Monte Carlo over the lobe (placed_lobe.t.h), whatever its model, by its own samples; Fresnel by sample.
#ifndef BN_MC_T_H
#define BN_MC_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/placed_lobe.t.h"
#include "shading/techniques/technique.t.h"

BN_KERNELS_BEGIN

// By a Hammersley set rotated by a hash of the pixel.
BN_FN real3 mc_of_lobe(frame_ref f, BN_IN(shaded_point) x, BN_IN(placed_lobe) lobe)
{
    bool meets_keys = !lobe_has(lobe.model, kNormals_ggx); // key lights leave it to samples
    cube_desc cube = specular_cube(f);
    uniform_real scale = 1.0f;
    if (meets_keys) {
        cube = whole_cube(f);
        scale = the_frame(f).whole.scale / the_frame(f).specular.scale;
    }
    int n = the_frame(f).samples;
    uniform_real inv = 1.0f / float(n);
    integer seed = k_hash_u32(x.pixel_id ^ int_lit(the_frame(f).seed));
    real shift_x = k_unit_from_bits(seed);
    real shift_y = k_unit_from_bits(k_hash_u32(seed));
    cube_terms sum;
    cube_terms_begin(sum, cube, false);
    for (int i = 0; i < n; ++i) {
        uniform_real column = (float(i) + 0.5f) * inv;
        real u = splat(column) + shift_x;
        real v = k_radical_inverse2(int_lit(i)) + shift_y;
        bsdf_sample b = placed_lobe_sample(lobe, vec2_of(u - floor(u), v - floor(v)));
        real3 fresnel = reflectance_of(x.s, b.o_dot_h);
        cube_terms_add(sum, b.wi, lit(0.0), fresnel, above_horizon(x, b.wi, b.weight));
    }
    real3 mean = cube_terms_value(sum) * splat(inv);
    if (meets_keys)
        mean = mean * splat(scale);
    return mirrors_apart(f, x, mean, placed_lobe_mirror_albedo(lobe));
}

BN_FN real3 mc_specular(frame_ref f, BN_IN(shaded_point) x)
{
    if ((the_frame(f).lobe_traits & kPunctualOnly) != 0)
        return vec3_all(lit(0.0));
    return mc_of_lobe(f, x, placed_lobe_at(f, x));
}

BN_KERNELS_END

#endif
