// Environment light of a fragment, from a technique's specular result.
#ifndef BN_ENVIRONMENT_T_H
#define BN_ENVIRONMENT_T_H

#include "shading/inputs/stage.h"
#include "shading/lang/lang.h"
#include "shading/surface/shaded_point.t.h"
#include "shading/techniques/shared_samples.k.h"

BN_KERNELS_BEGIN

// Returns the specular light after corrections for masking, tilt and horizon. A technique that does not sample the lobe
// takes it for the default one: untilted and entirely above the horizon. traits: the technique's.
BN_FN real3 seen_of_lobe(frame_ref f, BN_IN(shaded_point) x, int traits, real3 specular)
{
    real3 left = specular;
    // Scale to the substitute lobe's albedo
    if (uses_substitute_lobe(f) && (traits & kSamplesLobe) == 0) {
        left = specular * x.energy.albedo_ratio;
        if (lies_in_surface(f)) // the factor covers the horizon too
            return left;
    }
    // Fade at the surface's horizon
    if (x.has_surface_horizon && (traits & kTestsHorizon) == 0)
        return left * horizon_fade(x.lobe, x.s.n, x.s.v, x.geometric_axes.n);
    return left;
}

// Returns the mean radiance over cosine-weighted directions about the normal n, for the diffuse part. On a surface with
// geometric normal N, a share of (1 - n.N) / 2 lies below the horizon, and its light is subtracted. These directions form a
// lune. Their light is extrapolated from two means: about n, and about a direction d in the plane of n and N, about 30 degrees
// below the horizon. The result is exact for constant light, and for light that differs only above and below the horizon.
BN_FN real3 irradiance_at(frame_ref f, BN_IN(shaded_point) x)
{
    real3 about_n = cube_sample(irradiance_cube(f), x.s.n, lit(0.0)) * splat(the_frame(f).irradiance.scale);
    if (!x.has_surface_horizon)
        return about_n;
    // Find d, whose place nears -N as n does
    real cosine = min(max(k_dot3(x.s.n, x.geometric_axes.n), lit(-1.0)), lit(1.0));
    real away = lit(1.0) - cosine;
    real sine2 = away * (lit(1.0) + cosine);
    real depth = sqrt(sine2) * lit(0.5) + away * away * lit(0.3) + lit(1e-3);
    real3 d = x.s.n - x.geometric_axes.n * (cosine + depth);
    // Subtract the light below the horizon
    real above_n = lit(0.5) + lit(0.5) * cosine; // shares of both means above the horizon
    real above_d = lit(0.5) - lit(0.5) * depth / sqrt(sine2 + depth * depth);
    real weight = (lit(1.0) - above_n) * above_n / max(above_n - above_d, lit(1e-3));
    real3 about_d = cube_sample(irradiance_cube(f), d, lit(0.0)) * splat(the_frame(f).irradiance.scale);
    return max(about_n * (above_n + weight) - about_d * weight, vec3_all(lit(0.0)));
}

// Returns environment light. specular: from the technique. Occlusion dims everything.
BN_FN real3 environment_light(frame_ref f, BN_IN(shaded_point) x, int traits, real3 specular)
{
    // Scale and correct the specular part
    real3 scaled = BN_MUTANT(no_specular_image, specular * x.energy.gain * splat(the_frame(f).specular.scale), vec3_all(lit(0.0)));
    real3 seen = seen_of_lobe(f, x, traits, scaled);
    // Return it alone on metals
    if (!x.diffuse) {
        real3 alone = (seen + vec3_all(lit(0.0))) * x.s.occlusion; // adds 0 to keep the bits of the sum below
        return alone;
    }
    // Add the diffuse part
    real passed = diffuse_energy_share(f, x);
    real3 irradiance = irradiance_at(f, x);
    real3 sum = (seen + x.s.diffuse * irradiance * passed) * x.s.occlusion;
    return sum;
}

// Completes the record of a fragment whose technique shares samples. r: the technique's result; `rest` is what an unshared
// technique returns. more: light from other sources.
BN_FN shared_sample_record shared_light(frame_ref f, BN_IN(shaded_point) x, int traits, shared_sample_record r, real3 more)
{
    real3 whole = x.energy.albedo * x.energy.gain * splat(the_frame(f).specular.scale);
    r.factor = select(r.width < lit(0.0), vec3_all(lit(0.0)), seen_of_lobe(f, x, traits, whole) * x.s.occlusion);
    r.rest = environment_light(f, x, traits, r.rest) + more;
    return r;
}

BN_KERNELS_END

#endif
