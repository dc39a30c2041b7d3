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

// Light from the environment, by the technique of the frame; occlusion dims all of it.
template <Technique kTechnique>
BN_INLINE real3 environment_light(const FrameParams& f, const surface& s, const aniso_lobe& lobe, integer pixel_id,
                                  const dfg_value& dfg, real3 gain, real3 dielectric_f0, real dielectric_f90)
{
    const real3 albedo = s.f0 * dfg.scale + s.f90 * dfg.bias;
    const real3 dielectric = (dielectric_f0 * dfg.scale + vec3_all(dielectric_f90 * dfg.bias)) *
                             (f.energy_compensation ? energy_compensation(dielectric_f0, dfg) : vec3_all(lit(1.0)));
    const real3 specular =
        technique_specular<kTechnique>({f, s, lobe, albedo, pixel_id}) * gain * splat(f.specular_cube.scale);
    const real3 irradiance = cube_sample(lanes_cube(f.irradiance_cube), s.n, lit(0.0)) * splat(f.irradiance_cube.scale);
    const real passed = lit(1.0) - max(dielectric.x, max(dielectric.y, dielectric.z));
    return (specular + s.diffuse * irradiance * passed) * s.occlusion;
}

// lobe: null where the surface is isotropic.
BN_INLINE real3 light_from_punctual(const FrameParams& f, const surface& s, const aniso_lobe* lobe, real3 gain, real3 position)
{
    real3 sum = vec3_all(lit(0.0));
    for (int i = 0; i < f.light_count; ++i) {
        const LightRecord& l = f.lights[i];
        const light_sample at = sample_punctual(position, splat3(l.position), splat3(l.direction), splat(l.inv_range2),
                                                splat(l.spot_scale), splat(l.spot_offset),
                                                int_lit(l.directional) != int_lit(0));
        const real3 intensity = splat3(l.radiant) * at.attenuation;
        sum = sum + (lobe ? punctual_radiance_aniso(s, *lobe, at.l, gain, intensity) : punctual_radiance(s, at.l, gain, intensity));
    }
    return sum;
}

template <Technique kTechnique>
BN_INLINE real3 shade_fragments(const FrameParams& f, const MaterialRecord& m, const Fragment& p, integer pixel_id)
{
    const LaneMaterial at = fetch_material(f, m, p);
    if (m.unlit)
        return at.base;
    const real3 v = k_normalize3(-p.ray);
    // a surface seen from behind shows its other side
    const real3 normal = select(p.front, p.normal, -p.normal);
    const real handedness = select(p.front, p.tangent_sign, -p.tangent_sign);
    surface_frame frame = geometric_frame(normal, p.tangent, handedness);
    if (m.textures[kNormalTex].texture)
        frame = mapped_frame(frame, at.normal_map, handedness);
    const aniso_lobe lobe = material_lobe(f, m, at, frame);
    const real roughness = m.anisotropic ? lobe_alpha_lin(lobe) : at.roughness;
    const surface s = metallic_roughness_surface(frame.n, v, at.base, at.metallic, roughness, at.dielectric_f0,
                                                 at.dielectric_f90, at.occlusion);
    const dfg_value dfg =
        f.dfg_fit ? dfg_fit(s.n_dot_v, s.roughness) : dfg_lookup(f.dfg_texels, f.dfg_size, s.n_dot_v, s.roughness);
    const real3 gain = f.energy_compensation ? energy_compensation(s.f0, dfg) : vec3_all(lit(1.0));
    real3 color = environment_light<kTechnique>(f, s, lobe, pixel_id, dfg, gain, at.dielectric_f0, at.dielectric_f90) + at.emissive;
    if (f.light_count > 0) {
        const bool turned = m.anisotropic && kTechnique != Technique::split_isotropic;
        color = color + light_from_punctual(f, s, turned ? &lobe : nullptr, gain, p.position);
    }
    return color;
}

BN_INLINE real3 shade_background(const FrameParams& f, real3 ray)
{
    if (!f.background)
        return vec3_all(lit(0.0));
    return cube_sample(lanes_cube(f.specular_cube), ray, lit(0.0)) * splat(f.specular_cube.scale);
}

} // namespace BN_ISA_NS
} // namespace burnish
