// Common parts of techniques for environment light. A technique is a function <id>_specular(f, x) of a shaded_point x. It
// returns the radiance that the specular lobe reflects, before energy compensation and the environment's scale.
#ifndef BN_TECHNIQUE_T_H
#define BN_TECHNIQUE_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/shaded_point.t.h"

BN_KERNELS_BEGIN

// Returns the weight, or 0 where wi lies below the surface's horizon.
BN_FN real above_horizon(BN_IN(shaded_point) x, real3 wi, real weight)
{
    if (!x.has_surface_horizon)
        return weight;
    return select(k_dot3(x.geometric_axes.n, wi) > lit(0.0), weight, lit(0.0));
}

// Returns the direction to the eye in the lobe's own frame, never below its horizon.
BN_FN real3 eye_in_lobe(BN_IN(shaded_point) x)
{
    real3 o = to_lobe(x.lobe, x.s.n, x.s.v);
    o.z = max(o.z, lit(1e-4));
    return k_normalize3(o);
}

// Returns the environment in the mirror direction. dim: albedo of the mirror after masking.
BN_FN real3 mirrored(frame_ref f, BN_IN(shaded_point) x, real dim)
{
    real3 r = x.s.n * (lit(2.0) * k_dot3(x.s.n, x.s.v)) - x.s.v;
    real seen = above_horizon(x, r, dim);
    return cube_sample_level(prefiltered_env(f), r, 0) * x.energy.albedo * seen;
}

// Replaces the value by a mirror where the lobe has no width, since sampled lobes have a least width.
BN_FN real3 mirrors_apart(frame_ref f, BN_IN(shaded_point) x, real3 value, real dim)
{
    real width = x.lobe.sigma_u + x.lobe.sigma_v;
    mask mirror = width <= lit(1e-6);
    if (no_lane(mirror))
        return value;
    return select(mirror, mirrored(f, x, dim), value);
}

BN_KERNELS_END

#endif
