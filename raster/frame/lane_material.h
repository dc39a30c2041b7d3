// What shading knows of kLanes visible points of one material: attributes, texture fetches, the material's parameters, its lobe.
// `Frame` is a renderer's own table of the frame; read of it are texture_taps, override_anisotropy and anisotropy.
#pragma once
#include "raster/frame/lanes_records.h"
#include "shading/kernels/covariance.k.h"
#include "shading/kernels/lobe.k.h"
#include "shading/kernels/surface.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct Fragment {
    real3 normal, tangent; // world space, not unit
    real tangent_sign;
    real4 color;
    real2 uv[2], uv_dx[2], uv_dy[2]; // and their change by one pixel
    mask front;
    real3 ray;             // from the eye to the point, not unit
    real3 position;        // world space, metres; only where the frame has punctual lights
};

BN_INLINE real4 fetch_texture(int taps, const TextureBinding& b, const Fragment& p)
{
    const int set = b.uv_set != 0;
    const real m0 = splat(b.transform[0]), m1 = splat(b.transform[1]), m2 = splat(b.transform[2]), m3 = splat(b.transform[3]);
    const real2 uv = p.uv[set], dx = p.uv_dx[set], dy = p.uv_dy[set];
    const real2 at = vec2_of(m0 * uv.x + m2 * uv.y + splat(b.transform[4]), m1 * uv.x + m3 * uv.y + splat(b.transform[5]));
    const real2 at_dx = vec2_of(m0 * dx.x + m2 * dx.y, m1 * dx.x + m3 * dx.y);
    const real2 at_dy = vec2_of(m0 * dy.x + m2 * dy.y, m1 * dy.x + m3 * dy.y);
    return sample_binding(b, at, at_dx, at_dy, taps);
}

struct LaneMaterial { // a material's parameters at the fragments
    real3 base;
    real alpha;
    real metallic, roughness, occlusion;
    real3 normal_map;
    real3 emissive;
    real3 dielectric_f0;
    real dielectric_f90;
    real3 tensor2, tensor4; // anisotropy texels' tensors, see covariance_from_tensors
};

template <class Frame> BN_STAGE LaneMaterial fetch_material(const Frame& f, const MaterialRecord& m, const Fragment& p)
{
    LaneMaterial r;
    const auto fetch = [&](int slot) { return fetch_texture(f.texture_taps, m.textures[slot], p); };
    const auto used = [&](int slot) { return m.textures[slot].texture != nullptr; };
    r.base = splat3(m.base_color);
    r.alpha = splat(m.base_color[3]);
    if (used(kBaseColorTex)) {
        const real4 t = fetch(kBaseColorTex);
        r.base = r.base * vec3_of(t.x, t.y, t.z);
        r.alpha = r.alpha * t.w;
    }
    if (m.uses_color) {
        r.base = r.base * vec3_of(p.color.x, p.color.y, p.color.z);
        r.alpha = r.alpha * p.color.w;
    }
    r.metallic = splat(m.metallic);
    r.roughness = splat(m.roughness);
    if (used(kMetalRoughTex)) {
        const real4 t = fetch(kMetalRoughTex);
        if (!m.roughness_fixed)
            r.roughness = r.roughness * t.y;
        r.metallic = r.metallic * t.z;
    }
    r.normal_map = vec3_of(lit(0.0), lit(0.0), lit(1.0));
    if (used(kNormalTex)) {
        const real4 t = fetch(kNormalTex);
        const real scale = splat(m.normal_scale);
        r.normal_map = vec3_of((t.x * lit(2.0) - lit(1.0)) * scale, (t.y * lit(2.0) - lit(1.0)) * scale,
                               t.z * lit(2.0) - lit(1.0));
    }
    r.occlusion = lit(1.0);
    if (used(kOcclusionTex))
        r.occlusion = lit(1.0) + splat(m.occlusion_strength) * (fetch(kOcclusionTex).x - lit(1.0));
    r.emissive = splat3(m.emissive);
    if (used(kEmissiveTex)) {
        const real4 t = fetch(kEmissiveTex);
        r.emissive = r.emissive * vec3_of(t.x, t.y, t.z);
    }
    r.dielectric_f0 = splat3(m.dielectric_f0);
    r.dielectric_f90 = splat(m.dielectric_f90);
    if (used(kSpecularTex)) {
        const real t = fetch(kSpecularTex).w;
        r.dielectric_f0 = r.dielectric_f0 * t;
        r.dielectric_f90 = r.dielectric_f90 * t;
    }
    if (used(kSpecularColorTex)) {
        const real4 t = fetch(kSpecularColorTex);
        r.dielectric_f0 = r.dielectric_f0 * vec3_of(t.x, t.y, t.z);
    }
    r.tensor2 = r.tensor4 = vec3_of(lit(1.0), lit(0.0), lit(0.0));
    if (used(kTensor2Tex)) {
        const real4 t2 = fetch(kTensor2Tex), t4 = fetch(kTensor4Tex), rest2 = fetch(kTensor2RestTex), rest4 = fetch(kTensor4RestTex);
        r.tensor2 = vec3_of(t2.x + rest2.x, t2.y + rest2.y, t2.z + rest2.z); // halves alone bend thin lobes: at eta 0.95 by a fifth
        r.tensor4 = vec3_of(t4.x + rest4.x, t4.y + rest4.y, t4.z + rest4.z);
    }
    return r;
}

struct LobeShape { // a lobe before it is laid onto a surface
    real sigma_u, sigma_v; // see aniso_lobe
    real2 u;               // its axis, along tangent and bitangent
    real alpha_lin;        // perceptual roughness
};

// What is not anisotropic needs no axes of its own.
template <class Frame> BN_INLINE LobeShape lobe_shape(const Frame& f, const MaterialRecord& m, const LaneMaterial& at)
{
    LobeShape r;
    const real roughness = min(max(at.roughness, lit(0.0)), lit(1.0)), alpha = roughness * roughness;
    const real sigma = alpha * lit(0.70710678118654752);
    r.sigma_u = r.sigma_v = sigma;
    r.u = vec2_of(lit(1.0), lit(0.0));
    r.alpha_lin = at.roughness;
    if (!m.anisotropic)
        return r;
    const real2 rotation = vec2_of(splat(m.anisotropy_rotation[0]), splat(m.anisotropy_rotation[1]));
    const slope_covariance covariance =
        f.override_anisotropy
            ? covariance_from_eta_tensor(roughness, splat(f.anisotropy), rotation, at.tensor2)
            : covariance_from_tensors(alpha, splat(m.anisotropy_strength), rotation, at.tensor2, at.tensor4);
    const slope_axes axes = axes_of_covariance(covariance);
    const real trace = covariance.xx + covariance.yy;
    const mask mirror = trace <= lit(1e-12); // smooth in every direction: the decomposition's least widths are not for it
    r.sigma_u = select(mirror, sigma, axes.sigma_u);
    r.sigma_v = select(mirror, sigma, axes.sigma_v);
    r.u = axes.u;
    aniso_lobe lobe;
    lobe.sigma_u = r.sigma_u, lobe.sigma_v = r.sigma_v;
    r.alpha_lin = lobe_alpha_lin(lobe);
    return r;
}

BN_INLINE aniso_lobe lobe_in_frame(const MaterialRecord& m, const LobeShape& shape, const surface_frame& frame)
{
    aniso_lobe lobe;
    lobe.sigma_u = shape.sigma_u, lobe.sigma_v = shape.sigma_v;
    lobe.u_axis = frame.t, lobe.v_axis = frame.b;
    if (!m.anisotropic)
        return lobe;
    lobe.u_axis = frame.t * shape.u.x + frame.b * shape.u.y;
    lobe.v_axis = frame.b * shape.u.x - frame.t * shape.u.y;
    return lobe;
}

} // namespace BN_ISA_NS
} // namespace burnish
