// Light of the environment: what is made of a technique's result for the specular lobe.
#ifndef BN_ENVIRONMENT_T_H
#define BN_ENVIRONMENT_T_H

#include "shading/lang/lang.h"
#include "shading/lang/stage.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/techniques/shared_line.k.h"

BN_KERNELS_BEGIN

// traits: of the technique. What is left of a lobe that the technique took for the usual one, whole, upright and above the horizon.
BN_FN real3 seen_of_lobe(frame_ref f, BN_IN(shaded_point) x, int traits, real3 specular)
{
    real3 left = specular;
    if (stands_in(f) && (traits & kSamplesLobe) == 0) {
        left = specular * x.shown;
        if (lies_in_surface(f)) // the horizon's part is in it
            return left;
    }
    if (x.turned && (traits & kTestsHorizon) == 0)
        return left * horizon_fade(x.lobe, x.s.n, x.s.v, x.surface_axes.n);
    return left;
}

// What the diffuse part is lit by: the mean radiance over the cosine-weighted directions about the normal. Of those, a share of
// (1 - n.N) / 2 lies below the horizon of a surface whose own normal is N, where the light is taken to be what its back would have.
BN_FN real3 irradiance_at(frame_ref f, BN_IN(shaded_point) x)
{
    real3 whole = cube_sample(irradiance_cube(f), x.s.n, lit(0.0)) * splat(the_frame(f).irradiance.scale);
    if (!x.turned)
        return whole;
    real below = k_saturate(lit(0.5) - lit(0.5) * k_dot3(x.s.n, x.surface_axes.n));
    real3 back = cube_sample(irradiance_cube(f), -x.surface_axes.n, lit(0.0)) * splat(the_frame(f).irradiance.scale);
    return max(whole - back * below, vec3_all(lit(0.0)));
}

// specular: of the technique. Occlusion dims all of it.
BN_FN real3 environment_light(frame_ref f, BN_IN(shaded_point) x, int traits, real3 specular)
{
    real3 scaled = specular * x.gain * splat(the_frame(f).specular.scale);
    real3 seen = seen_of_lobe(f, x, traits, scaled);
    if (!x.diffuse) {
        real3 alone = (seen + vec3_all(lit(0.0))) * x.s.occlusion; // as if nothing were added
        return alone;
    }
    real passed = passed_to_diffuse(f, x);
    real3 irradiance = irradiance_at(f, x);
    real3 sum = (seen + x.s.diffuse * irradiance * passed) * x.s.occlusion;
    return sum;
}

// Of a fragment whose technique shares samples. r: what it found, `rest` being what a technique returns that shares none; more: light that
// is not the environment's.
BN_FN line_record shared_light(frame_ref f, BN_IN(shaded_point) x, int traits, line_record r, real3 more)
{
    real3 whole = x.albedo * x.gain * splat(the_frame(f).specular.scale);
    r.factor = select(r.width < lit(0.0), vec3_all(lit(0.0)), seen_of_lobe(f, x, traits, whole) * x.s.occlusion);
    r.rest = environment_light(f, x, traits, r.rest) + more;
    return r;
}

BN_KERNELS_END

#endif
