// Pixel samples under a fragment: their share and mean position, alpha tests, and blending with surfaces in front.
#ifndef BN_COVERAGE_T_H
#define BN_COVERAGE_T_H

#include "shading/lang/frame.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// Returns the samples' share of the pixel, [0,1]. samples: a mask with at most 16 bits, bit i = sample i; each: the share
// of one sample.
BN_FN real covered_share(integer samples, real each)
{
    // Count the set bits in pairs, fours, eights and all
    integer pairs = samples - (shr_logical(samples, 1) & int_lit(0x5555));
    integer fours = (pairs & int_lit(0x3333)) + (shr_logical(pairs, 2) & int_lit(0x3333));
    integer eights = (fours + shr_logical(fours, 4)) & int_lit(0x0f0f);
    return to_real((eights + shr_logical(eights, 8)) & int_lit(0x1f)) * each;
}

struct sample_mean { // position from the pixel's top left corner, 1/256 pixel
    integer x, y;
};

// Returns the mean position of the samples. The mean lies inside a triangle that covers them.
BN_FN sample_mean mean_of_samples(frame_ref f, integer samples)
{
    // Sum the covered samples' positions
    integer sum_x = int_lit(0);
    integer sum_y = int_lit(0);
    integer count = int_lit(0);
    for (int s = 0; s < the_frame(f).msaa; ++s) {
        integer bit = shr_logical(samples, s) & int_lit(1);
        sum_x = sum_x + bit * int_lit(the_frame(f).pattern.x[s]);
        sum_y = sum_y + bit * int_lit(the_frame(f).pattern.y[s]);
        count = count + bit;
    }
    // Divide by their number
    real inv = lit(1.0) / max(to_real(count), lit(1.0));
    real x = to_real(sum_x) * inv;
    real y = to_real(sum_y) * inv;
    sample_mean r;
    r.x = to_int(x);
    r.y = to_int(y);
    return r;
}

// Returns true where a sample of a non-opaque material stays. A mask discards the whole fragment. threshold: for blended
// materials, in renderers that draw them by chance (a random number in [0,1)) or by majority (a half).
BN_FN mask alpha_stays(material_ref m, real alpha, real threshold)
{
    if (the_material(m).alpha_mode == kAlpha_blend)
        return alpha > threshold;
    real cutoff = splat(the_material(m).alpha_cutoff);
    return alpha >= cutoff;
}

// Blended surfaces in front of a sample, composed front to back (the "over" operator, Porter and Duff 1984).
struct blended_light {
    real3 over;   // their light, each weighted by its alpha and the transmittance in front
    real through; // transmittance: share of the light behind that passes, [0,1]
};
// Returns the state with nothing blended.
BN_FN blended_light blended_none()
{
    blended_light b;
    b.over = vec3_all(lit(0.0));
    b.through = lit(1.0);
    return b;
}
// Adds the next surface behind. Clamps alpha to [0,1]. Transmittance below 1e-30 counts as 0.
BN_FN blended_light blend_behind(BN_IN(blended_light) b, real3 colour, real alpha)
{
    real covers = min(max(alpha, lit(0.0)), lit(1.0));
    real share = b.through * covers;
    real left = b.through * (lit(1.0) - covers);
    blended_light r;
    r.over = b.over + colour * share;
    r.through = select(left > lit(1e-30), left, lit(0.0));
    return r;
}
// Returns the light of a sample whose opaque surface or background has `colour`.
BN_FN real3 blend_over(BN_IN(blended_light) b, real3 colour)
{
    return b.over + colour * b.through;
}

BN_KERNELS_END

#endif
