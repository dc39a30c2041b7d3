// One punctual light on a surface: GGX with height-correlated Smith and Schlick, plus Lambert. glTF 2.0, appendix B.
#ifndef BN_PUNCTUAL_K_H
#define BN_PUNCTUAL_K_H

#include "shading/kernels/ggx.k.h"
#include "shading/kernels/surface.k.h"
#include "shading/lang/lang.h"

BN_KERNELS_BEGIN

// l: unit, to the light. intensity: irradiance on a surface facing the light, lux. Returns outgoing radiance.
BN_FN real3 punctual_radiance(surface s, real3 l, real3 intensity)
{
    real3 h = k_normalize3(l + s.v);
    real n_dot_l = k_dot3(s.n, l);
    real n_dot_h = min(max(k_dot3(s.n, h), lit(0.0)), lit(1.0));
    real v_dot_h = min(max(k_dot3(s.v, h), lit(0.0)), lit(1.0));
    real3 c = k_cross(s.n, h);
    real alpha = max(s.roughness * s.roughness, lit(1e-3));
    real d = ggx_d(n_dot_h, k_dot3(c, c), alpha);
    real g = ggx_visibility(max(n_dot_l, lit(1e-4)), s.n_dot_v, alpha);
    real3 f = fresnel_schlick(s.f0, s.f90, v_dot_h);
    real3 one = vec3_all(lit(1.0));
    real3 f_diffuse = (one - f) * s.diffuse * lit(0.31830988618379067);
    real3 value = (f_diffuse + f * (d * g)) * intensity * n_dot_l;
    return select(n_dot_l > lit(0.0), value, vec3_all(lit(0.0)));
}

struct light_sample {
    real3 l;         // unit, to the light
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
