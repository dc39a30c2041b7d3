// Shading of visible fragments, kLanes at a time, all of one material: interpolate, fetch textures, run the kernels.
#pragma once
#include "raster/tile/fragment.h"
#include "raster/tile/techniques.h"
#include "shading/kernels/dfg.k.h"
#include "shading/kernels/energy.k.h"
#include "shading/kernels/punctual.k.h"
#include "shading/kernels/surface.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

// What is shaded, once its material is known.
struct Shading {
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

// Directional albedo of the lobe by the table of its roughness, which is that of a round one: what techniques scale prefiltered light by.
// Energy compensation returns exactly what is missing, so it asks for the lobe's own.
BN_INLINE dfg_value directional_albedo(const FrameParams& f, bool anisotropic, const surface& s, const aniso_lobe& lobe)
{
    if (f.dfg_fit)
        return dfg_fit(s.n_dot_v, s.roughness);
    if (f.energy_compensation && anisotropic)
        return lobe_albedo_lookup(f.lobe_albedo_texels, f.lobe_albedo_size, lobe, s.n, s.v);
    return dfg_lookup(f.dfg_texels, f.dfg_size, s.n_dot_v, s.roughness);
}

BN_INLINE real3 energy_gain(const FrameParams& f, real3 f0, const dfg_value& dfg)
{
    return f.energy_compensation ? energy_compensation(f0, dfg) : vec3_all(lit(1.0));
}

// Light from the environment, by the technique of the frame; occlusion dims all of it.
template <Technique kTechnique> BN_INLINE real3 environment_light(const FrameParams& f, const Shading& x, integer pixel_id)
{
    const surface& s = x.s;
    const real3 albedo = s.f0 * x.dfg.scale + s.f90 * x.dfg.bias;
    const TechniqueInput input = {f, s, x.lobe, albedo, pixel_id, x.surface_axes, x.turned, x.gain};
    real3 specular = technique_specular<kTechnique>(input) * x.gain * splat(f.specular_cube.scale);
    if (f.tilted && kTechnique != Technique::mc) { // which samples the tilted lobe itself
        const LaneEllipsoid e = lobe_on_surface(x.lobe, s, x.surface_axes);
        const real upright = tests_horizon(kTechnique) ? lit(1.0) : max(x.dfg.scale + x.dfg.bias, lit(0.05)); // what is in already
        specular = specular * (ellipsoid_albedo(e.p, e.o) / upright);
    } else if (x.turned && !tests_horizon(kTechnique)) {
        const real3 mirrored = s.n * (lit(2.0) * k_dot3(s.n, s.v)) - s.v;
        specular = specular * horizon_fade(x.surface_axes.n, mirrored, s.roughness * s.roughness);
    }
    if (!x.diffuse)
        return (specular + vec3_all(lit(0.0))) * s.occlusion; // as if nothing were added
    const real3 dielectric = (x.dielectric_f0 * x.dfg.scale + vec3_all(x.dielectric_f90 * x.dfg.bias)) * energy_gain(f, x.dielectric_f0, x.dfg);
    const real3 irradiance = cube_sample(lanes_cube(f.irradiance_cube), s.n, lit(0.0)) * splat(f.irradiance_cube.scale);
    const real passed = lit(1.0) - max(dielectric.x, max(dielectric.y, dielectric.z));
    return (specular + s.diffuse * irradiance * passed) * s.occlusion;
}

// D G / (4 cosines) of a tilted lobe, times the cosine of the light, which is the surface's.
BN_INLINE real ellipsoid_light(const LaneEllipsoid& e, real3 wi) { return ellipsoid_eval(e.p, e.o, wi) * max(wi.z, lit(0.0)); }

// anisotropic: by the lobe itself, otherwise by a round one of the same roughness.
BN_INLINE real3 light_from_punctual(const FrameParams& f, const Shading& x, bool anisotropic, real3 position)
{
    real3 sum = vec3_all(lit(0.0));
    LaneEllipsoid e;
    if (f.tilted)
        e = lobe_on_surface(x.lobe, x.s, x.surface_axes);
    for (int i = 0; i < f.light_count; ++i) {
        const LightRecord& l = f.lights[i];
        const light_sample at = sample_punctual(position, splat3(l.position), splat3(l.direction), splat(l.inv_range2),
                                                splat(l.spot_scale), splat(l.spot_offset),
                                                int_lit(l.directional) != int_lit(0));
        const real3 intensity = splat3(l.radiant) * at.attenuation;
        real3 light;
        if (f.tilted)
            light = punctual_radiance_tilted(x.s, at.l, ellipsoid_light(e, in_frame(x.surface_axes, at.l)), x.gain, intensity);
        else
            light = anisotropic ? punctual_radiance_aniso(x.s, x.lobe, at.l, x.gain, intensity)
                                : punctual_radiance(x.s, at.l, x.gain, intensity);
        sum = sum + (x.turned ? select(k_dot3(x.surface_axes.n, at.l) > lit(0.0), light, vec3_all(lit(0.0))) : light);
    }
    return sum;
}

// What is the same for all fragments of a material, found once.
struct MaterialPlan {
    bool diffuse;        // some light may be diffused
    bool uniform;        // nothing changes from fragment to fragment
    LaneMaterial at;     // then
    bool one_shape;      // no texture changes the lobe's shape
    LobeShape shape;     // then
};

BN_INLINE MaterialPlan plan_material(const FrameParams& f, const MaterialRecord& m)
{
    const auto used = [&](int slot) { return m.textures[slot].texture != nullptr; };
    MaterialPlan plan;
    plan.diffuse = m.metallic < 1.0f || used(kMetalRoughTex);
    plan.one_shape = (!used(kMetalRoughTex) || m.roughness_fixed) && !used(kTensor2Tex);
    plan.uniform = !m.textured && !m.uses_color;
    if (plan.uniform)
        plan.at = fetch_material(f, m, Fragment{});
    plan.at.roughness = splat(m.roughness);
    plan.at.tensor2 = plan.at.tensor4 = vec3_of(lit(1.0), lit(0.0), lit(0.0));
    plan.shape = lobe_shape(f, m, plan.at);
    return plan;
}

template <Technique kTechnique>
BN_INLINE real3 shade_fragments(const FrameParams& f, const MaterialRecord& m, const MaterialPlan& plan, const Fragment& p,
                                integer pixel_id)
{
    LaneMaterial fetched;
    if (!plan.uniform)
        fetched = fetch_material(f, m, p);
    const LaneMaterial& at = plan.uniform ? plan.at : fetched;
    if (m.unlit)
        return at.base;
    const real3 v = k_normalize3(-p.ray);
    // a surface seen from behind shows its other side
    const real3 normal = select(p.front, p.normal, -p.normal);
    const real handedness = select(p.front, p.tangent_sign, -p.tangent_sign);
    Shading x;
    x.surface_axes = geometric_frame(normal, p.tangent, handedness);
    surface_frame frame = x.surface_axes;
    const bool mapped = m.textures[kNormalTex].texture != nullptr;
    if (mapped)
        frame = mapped_frame(frame, at.normal_map, handedness);
    if (f.tilted)
        frame = tilted_frame(frame, vec2_of(splat(f.tilt_cos[0]), splat(f.tilt_cos[1])), vec2_of(splat(f.tilt_sin[0]), splat(f.tilt_sin[1])));
    x.turned = (mapped && f.horizon) || f.tilted;
    const LobeShape shape = plan.one_shape ? plan.shape : lobe_shape(f, m, at);
    x.lobe = lobe_in_frame(m, shape, frame);
    x.diffuse = plan.diffuse;
    x.dielectric_f0 = at.dielectric_f0, x.dielectric_f90 = at.dielectric_f90;
    x.s = metallic_roughness_surface(frame.n, v, at.base, at.metallic, shape.alpha_lin, at.dielectric_f0, at.dielectric_f90, at.occlusion);
    x.dfg = directional_albedo(f, m.anisotropic, x.s, x.lobe);
    x.gain = energy_gain(f, x.s.f0, x.dfg);
    if (f.tilted && f.energy_compensation) {
        const LaneEllipsoid e = lobe_on_surface(x.lobe, x.s, x.surface_axes);
        x.gain = energy_compensation_of_albedo(x.s.f0, min(ellipsoid_albedo(e.p, e.o), lit(1.0)));
    }
    real3 color = environment_light<kTechnique>(f, x, pixel_id) + at.emissive;
    if (f.light_count > 0)
        color = color + light_from_punctual(f, x, m.anisotropic && kTechnique != Technique::split_isotropic, p.position);
    return color;
}

} // namespace BN_ISA_NS
} // namespace burnish
