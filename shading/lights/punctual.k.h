// One punctual light on a surface: a specular lobe with its reflectance, plus the diffuse part. glTF 2.0, appendix B ("BRDF
// Implementation"), and KHR_lights_punctual.
#ifndef BN_PUNCTUAL_K_H
#define BN_PUNCTUAL_K_H

#include "shading/kernels/math.k.h"
#include "shading/lang/lang.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// Returns the cosine between the eye and the half vector, for Fresnel. l: unit, to the light.
BN_FN real punctual_v_dot_h(surface s, real3 l)
{
    real3 h = k_normalize3(l + s.v);
    return min(max(k_dot3(s.v, h), lit(0.0)), lit(1.0));
}

// Returns reflected radiance. l: unit, to the light. lobe: the specular lobe's BRDF there, without Fresnel reflectance f.
// diffuse: BRDF of the diffuse part, 1/sr. gain: factor on the specular lobe. intensity: irradiance on a surface that faces
// the light, lux.
BN_FN real3 punctual_radiance(surface s, real3 l, real lobe, real3 f, real3 diffuse, real3 gain, real3 intensity)
{
    real n_dot_l = k_dot3(s.n, l);
    real3 value = (diffuse + f * gain * lobe) * intensity * n_dot_l;
    return select(n_dot_l > lit(0.0), value, vec3_all(lit(0.0)));
}

// Returns the same from a lobe value that includes the light's cosine. A lobe in the surface's frame uses another cosine
// than the shading normal's.
BN_FN real3 punctual_radiance_apart(surface s, real3 l, real lobe_cosine, real3 f, real3 diffuse, real3 gain, real3 intensity)
{
    real n_dot_l = max(k_dot3(s.n, l), lit(0.0));
    return (diffuse * n_dot_l + f * gain * lobe_cosine) * intensity;
}

struct light_sample {
    real3 l;          // unit, to the light
    real attenuation; // irradiance per unit of the light's radiant intensity
};

// Samples a light by KHR_lights_punctual: inverse square with a window at `range`, and a smooth cone. p: shaded point,
// world space; all else is uniform.
BN_FN light_sample sample_punctual(real3 p, real3 position, real3 direction, real inv_range2, real spot_scale, real spot_offset,
                                   mask directional)
{
    // Find the direction
    real3 d = select(directional, -direction, position - p);
    real d2 = max(k_dot3(d, d), lit(1e-12));
    real3 l = d / sqrt(d2);
    // Compute the range window and the cone
    real window = d2 * inv_range2;
    window = lit(1.0) - window * window;
    window = min(max(window, lit(0.0)), lit(1.0));
    real cone = (-k_dot3(direction, l)) * spot_scale + spot_offset;
    cone = min(max(cone, lit(0.0)), lit(1.0));
    light_sample r;
    r.l = l;
    r.attenuation = select(directional, lit(1.0), window * cone * cone / d2);
    return r;
}

BN_KERNELS_END

#endif
