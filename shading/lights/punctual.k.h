// One punctual light on a surface: GGX, isotropic or anisotropic, with height-correlated Smith and Schlick, plus Lambert.
// glTF 2.0, appendix B ("BRDF Implementation"), and its extension KHR_lights_punctual.
#ifndef BN_PUNCTUAL_K_H
#define BN_PUNCTUAL_K_H

#include "shading/lang/lang.h"
#include "shading/models/ggx.k.h"
#include "shading/models/ggx_aniso.k.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"

BN_KERNELS_BEGIN

// l: unit, to the light. d_g: the specular lobe's D G2 / (4 cosines) there. gain: factor on the specular lobe.
// intensity: irradiance on a surface facing the light, lux. Returns outgoing radiance.
BN_FN real3 punctual_radiance_of(surface s, real3 l, real d_g, real3 gain, real3 intensity)
{
    real3 h = k_normalize3(l + s.v);
    real n_dot_l = k_dot3(s.n, l);
    real v_dot_h = min(max(k_dot3(s.v, h), lit(0.0)), lit(1.0));
    real3 f = fresnel_schlick(s.f0, s.f90, v_dot_h);
    real3 one = vec3_all(lit(1.0));
    real3 f_diffuse = (one - f) * s.diffuse * lit(0.31830988618379067);
    real3 value = (f_diffuse + f * gain * d_g) * intensity * n_dot_l;
    return select(n_dot_l > lit(0.0), value, vec3_all(lit(0.0)));
}

// With an isotropic lobe of the surface's roughness.
BN_FN real3 punctual_radiance(surface s, real3 l, real3 gain, real3 intensity)
{
    real3 h = k_normalize3(l + s.v);
    real n_dot_h = min(max(k_dot3(s.n, h), lit(0.0)), lit(1.0));
    real3 c = k_cross(s.n, h);
    real alpha = max(s.roughness * s.roughness, lit(1e-3));
    real d = ggx_d(n_dot_h, k_dot3(c, c), alpha);
    real g = ggx_visibility(max(k_dot3(s.n, l), lit(1e-4)), s.n_dot_v, alpha);
    real d_g = d * g;
    return punctual_radiance_of(s, l, d_g, gain, intensity);
}

// With an anisotropic one.
BN_FN real3 punctual_radiance_aniso(surface s, aniso_lobe lobe, real3 l, real3 gain, real3 intensity)
{
    real root2 = lit(1.4142135623730951);
    real alpha_u = lobe.sigma_u * root2;
    real alpha_v = lobe.sigma_v * root2;
    ggx_aniso_params p = ggx_aniso_params_of(alpha_u, alpha_v);
    real3 wo = to_lobe(lobe, s.n, s.v);
    real3 wi = to_lobe(lobe, s.n, l);
    wo.z = s.n_dot_v;
    wi.z = max(wi.z, lit(1e-4));
    real d = ggx_aniso_d(p, half_vector(wo, wi));
    real d_g = d * ggx_aniso_visibility(p, wo, wi);
    return punctual_radiance_of(s, l, d_g, gain, intensity);
}

// With a lobe whose value times the light's cosine is given: a tilted one's cosine is not the shading normal's.
BN_FN real3 punctual_radiance_tilted(surface s, real3 l, real lobe_cosine, real3 gain, real3 intensity)
{
    real3 h = k_normalize3(l + s.v);
    real v_dot_h = min(max(k_dot3(s.v, h), lit(0.0)), lit(1.0));
    real3 f = fresnel_schlick(s.f0, s.f90, v_dot_h);
    real3 one = vec3_all(lit(1.0));
    real n_dot_l = max(k_dot3(s.n, l), lit(0.0));
    real diffuse_cosine = n_dot_l * lit(0.31830988618379067);
    real3 diffused = (one - f) * s.diffuse * diffuse_cosine;
    return (diffused + f * gain * lobe_cosine) * intensity;
}

struct light_sample {
    real3 l;          // unit, to the light
    real attenuation; // times the light's radiant intensity gives irradiance
};

// KHR_lights_punctual: inverse square with a window at `range`, smooth cone. All but p are uniform. p: shaded point, world space.
BN_FN light_sample sample_punctual(real3 p, real3 position, real3 direction, real inv_range2, real spot_scale, real spot_offset,
                                   mask directional)
{
    real3 d = select(directional, -direction, position - p);
    real d2 = max(k_dot3(d, d), lit(1e-12));
    real3 l = d / sqrt(d2);
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
