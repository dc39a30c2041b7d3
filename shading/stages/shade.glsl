// Shading of one visible (pixel, triangle) pair. As raster/tile/shade.h.
#ifndef BN_SHADE_GLSL
#define BN_SHADE_GLSL

#include "shading/stages/backdrop.glsl"
#include "shading/stages/techniques.glsl"
#include "shading/stages/material.glsl"
#include "shading/kernels/dfg.k.h"
#include "shading/kernels/energy.k.h"
#include "shading/kernels/punctual.k.h"

layout(constant_id = 1) const bool kTestsHorizon = false;   // the technique asks of every sample if it lies above the horizon
layout(constant_id = 2) const bool kSamplesTilt = false;    // it samples a tilted lobe itself
layout(constant_id = 3) const bool kIsotropicLights = false; // lights see an isotropic lobe

struct shading_point {
    surface s;
    aniso_lobe lobe;
    surface_frame surface_axes; // the geometry's
    bool turned;                // s.n is not surface_axes.n
    bool diffuse;               // s.diffuse may be above 0
    dfg_value dfg;
    real3 gain;                 // of the specular lobe
    real3 dielectric_f0;
    real dielectric_f90;
};

dfg_value directional_albedo(bool anisotropic, surface s, aniso_lobe lobe)
{
    if (frame.dfg_fit != 0)
        return dfg_fit(s.n_dot_v, s.roughness);
    if (frame.energy_compensation != 0 && anisotropic)
        return lobe_albedo_lookup(frame.lobe_albedo_page, frame.lobe_albedo_size, lobe, s.n, s.v);
    return dfg_lookup(frame.dfg_page, frame.dfg_size, s.n_dot_v, s.roughness);
}

real3 energy_gain(real3 f0, dfg_value dfg)
{
    if (frame.energy_compensation == 0)
        return vec3_all(lit(1.0));
    return energy_compensation(f0, dfg);
}

real3 environment_light(shading_point x, int pixel_id)
{
    surface s = x.s;
    real3 albedo = s.f0 * x.dfg.scale + s.f90 * x.dfg.bias;
    technique_input ti = technique_input(s, x.lobe, albedo, pixel_id, x.surface_axes, x.turned, x.gain);
    real3 specular = technique_specular(ti) * x.gain * frame.specular.scale;
    if (frame.tilted != 0 && !kSamplesTilt) {
        placed_ellipsoid e = lobe_on_surface(x.lobe, s, x.surface_axes);
        real upright = kTestsHorizon ? lit(1.0) : max(x.dfg.scale + x.dfg.bias, lit(0.05)); // what is in already
        real shown = ellipsoid_albedo(e.p, e.o) / upright;
        specular = specular * shown;
    } else if (x.turned && !kTestsHorizon) {
        real3 mirrored = s.n * (lit(2.0) * k_dot3(s.n, s.v)) - s.v;
        real alpha = s.roughness * s.roughness;
        specular = specular * horizon_fade(x.surface_axes.n, mirrored, alpha);
    }
    if (!x.diffuse) {
        real3 alone = (specular + vec3_all(lit(0.0))) * s.occlusion; // as if nothing were added
        return alone;
    }
    real bias = x.dielectric_f90 * x.dfg.bias;
    real3 dielectric = (x.dielectric_f0 * x.dfg.scale + vec3_all(bias)) * energy_gain(x.dielectric_f0, x.dfg);
    real3 irradiance = cube_sample(irradiance_cube(), s.n, lit(0.0)) * frame.irradiance.scale;
    real passed = lit(1.0) - max(dielectric.x, max(dielectric.y, dielectric.z));
    real3 sum = (specular + s.diffuse * irradiance * passed) * s.occlusion;
    return sum;
}

real3 light_from_punctual(shading_point x, bool anisotropic, real3 position)
{
    real3 sum = vec3_all(lit(0.0));
    placed_ellipsoid e = lobe_on_surface(x.lobe, x.s, x.surface_axes);
    for (int i = 0; i < frame.light_count; ++i) {
        real3 at = vec3(lights[i].position[0], lights[i].position[1], lights[i].position[2]);
        real3 direction = vec3(lights[i].direction[0], lights[i].direction[1], lights[i].direction[2]);
        real3 radiant = vec3(lights[i].radiant[0], lights[i].radiant[1], lights[i].radiant[2]);
        light_sample l = sample_punctual(position, at, direction, lights[i].inv_range2, lights[i].spot_scale, lights[i].spot_offset,
                                         lights[i].directional != 0);
        real3 intensity = radiant * l.attenuation;
        real3 light;
        if (frame.tilted != 0) {
            real3 wi = in_surface_frame(x.surface_axes, l.l);
            real lobe_cosine = ellipsoid_eval(e.p, e.o, wi) * max(wi.z, lit(0.0));
            light = punctual_radiance_tilted(x.s, l.l, lobe_cosine, x.gain, intensity);
        } else if (anisotropic)
            light = punctual_radiance_aniso(x.s, x.lobe, l.l, x.gain, intensity);
        else
            light = punctual_radiance(x.s, l.l, x.gain, intensity);
        if (x.turned)
            light = select(k_dot3(x.surface_axes.n, l.l) > lit(0.0), light, vec3_all(lit(0.0)));
        sum = sum + light;
    }
    return sum;
}

real3 shade_point(int m, material_inputs at, visible_point p, int pixel_id)
{
    if (materials[m].unlit != 0)
        return at.base;
    real3 v = k_normalize3(-p.ray);
    // a surface seen from behind shows its other side
    real3 normal = select(p.front, p.normal, -p.normal);
    real handedness = select(p.front, p.tangent_sign, -p.tangent_sign);
    shading_point x;
    x.surface_axes = geometric_frame(normal, p.tangent, handedness);
    surface_frame axes = x.surface_axes;
    bool mapped = texture_used(m, kNormalTex);
    if (mapped)
        axes = mapped_frame(axes, at.normal_map, handedness);
    if (frame.tilted != 0)
        axes = tilted_frame(axes, vec2(frame.tilt_cos[0], frame.tilt_cos[1]), vec2(frame.tilt_sin[0], frame.tilt_sin[1]));
    x.turned = (mapped && frame.horizon != 0) || frame.tilted != 0;
    lobe_shape shape = shape_of(m, at);
    x.lobe = lobe_in_frame(m, shape, axes);
    x.diffuse = materials[m].metallic < 1.0 || texture_used(m, kMetalRoughTex);
    x.dielectric_f0 = at.dielectric_f0;
    x.dielectric_f90 = at.dielectric_f90;
    x.s = metallic_roughness_surface(axes.n, v, at.base, at.metallic, shape.alpha_lin, at.dielectric_f0, at.dielectric_f90, at.occlusion);
    x.dfg = directional_albedo(materials[m].anisotropic != 0, x.s, x.lobe);
    x.gain = energy_gain(x.s.f0, x.dfg);
    if (frame.tilted != 0 && frame.energy_compensation != 0) {
        placed_ellipsoid e = lobe_on_surface(x.lobe, x.s, x.surface_axes);
        real kept = min(ellipsoid_albedo(e.p, e.o), lit(1.0));
        x.gain = energy_compensation_of_albedo(x.s.f0, kept);
    }
    real3 color = environment_light(x, pixel_id) + at.emissive;
    if (frame.light_count > 0)
        color = color + light_from_punctual(x, materials[m].anisotropic != 0 && !kIsotropicLights, p.position);
    return color;
}

#endif
