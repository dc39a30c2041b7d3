// The samples of a pixel that a fragment covers: how much of it they are, where their mean lies, which of them the material's alpha leaves.
#ifndef BN_COVERAGE_T_H
#define BN_COVERAGE_T_H

#include "shading/lang/frame.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Their share of the pixel, [0,1]. samples: a mask of at most 16, bit i = sample i; each: the share of one.
BN_FN real covered_share(integer samples, real each)
{
    integer pairs = samples - (shr_logical(samples, 1) & int_lit(0x5555));
    integer fours = (pairs & int_lit(0x3333)) + (shr_logical(pairs, 2) & int_lit(0x3333));
    integer eights = (fours + shr_logical(fours, 4)) & int_lit(0x0f0f);
    return to_real((eights + shr_logical(eights, 8)) & int_lit(0x1f)) * each;
}

struct sample_mean { // from the pixel's top left corner, 1/256 pixel
    integer x, y;
};

// It lies in the triangle that covers them.
BN_FN sample_mean mean_of_samples(frame_ref f, integer samples)
{
    integer sum_x = int_lit(0);
    integer sum_y = int_lit(0);
    integer count = int_lit(0);
    for (int s = 0; s < the_frame(f).msaa; ++s) {
        integer bit = shr_logical(samples, s) & int_lit(1);
        sum_x = sum_x + bit * int_lit(the_frame(f).pattern.x[s]);
        sum_y = sum_y + bit * int_lit(the_frame(f).pattern.y[s]);
        count = count + bit;
    }
    real inv = lit(1.0) / max(to_real(count), lit(1.0));
    real x = to_real(sum_x) * inv;
    real y = to_real(sum_y) * inv;
    sample_mean r;
    r.x = to_int(x);
    r.y = to_int(y);
    return r;
}

// What a blended alpha must exceed at sample s of n.
BN_FN uniform_real blend_threshold(int s, int n)
{
    return (float(s) + 0.5f) / float(n);
}

// Whether a sample stays, of a material that is not opaque. A mask discards the whole fragment; a blend becomes coverage, so the resolved
// pixel shows about `alpha` of the surface, without sorting. threshold: of a blend, blend_threshold() or a random number in [0,1).
BN_FN mask alpha_stays(material_ref m, real alpha, real threshold)
{
    if (the_material(m).alpha_mode == kAlpha_blend)
        return alpha > threshold;
    real cutoff = splat(the_material(m).alpha_cutoff);
    return alpha >= cutoff;
}

BN_KERNELS_END

#endif
