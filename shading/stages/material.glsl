// Texture fetches and the material's parameters at a visible point, and its lobe. As raster/frame/lane_material.h.
#ifndef BN_MATERIAL_GLSL
#define BN_MATERIAL_GLSL

#include "shading/stages/fragment.glsl"
#include "shading/kernels/covariance.k.h"
#include "shading/kernels/lobe.k.h"
#include "shading/kernels/surface.k.h"
#include "shading/kernels/texture_filter.k.h"

const int kBaseColorTex = 0, kMetalRoughTex = 1, kNormalTex = 2, kOcclusionTex = 3, kEmissiveTex = 4, kSpecularTex = 5,
          kSpecularColorTex = 6, kTensor2Tex = 7, kTensor4Tex = 8, kTensor2RestTex = 9, kTensor4RestTex = 10;

#ifdef BN_NATIVE_SAMPLER
layout(set = 1, binding = 1) uniform sampler2D native_textures[kGpuTextureSlots]; // of the drawn material
#endif

#ifdef BN_NATIVE_SAMPLER
#define BN_SLOT(i)                                                                                                                         \
    if (slot == i)                                                                                                                         \
        return textureLod(native_textures[i], uv, lod);
vec4 native_texel(int slot, vec2 uv, float lod) // not every device indexes samplers by a variable
{
    BN_SLOT(0) BN_SLOT(1) BN_SLOT(2) BN_SLOT(3) BN_SLOT(4) BN_SLOT(5) BN_SLOT(6) BN_SLOT(7) BN_SLOT(8)
    return textureLod(native_textures[9], uv, lod);
}
#endif

layout(constant_id = 5) const int kUsedTextures = -1; // of the only material, a bit a slot; -1: of any material, see its record

bool texture_used(int material, int slot)
{
    return kUsedTextures >= 0 ? (kUsedTextures >> slot & 1) != 0 : materials[material].textures[slot].texture >= 0;
}

real4 fetch_texture(int material, int slot, visible_point p)
{
    int set = materials[material].textures[slot].uv_set != 0 ? 1 : 0;
    real m[6];
    for (int i = 0; i < 6; ++i)
        m[i] = materials[material].textures[slot].transform[i];
    real2 uv = p.uv[set];
    real2 dx = p.uv_dx[set];
    real2 dy = p.uv_dy[set];
    real2 at = vec2(m[0] * uv.x + m[2] * uv.y + m[4], m[1] * uv.x + m[3] * uv.y + m[5]);
    real2 at_dx = vec2(m[0] * dx.x + m[2] * dx.y, m[1] * dx.x + m[3] * dx.y);
    real2 at_dy = vec2(m[0] * dy.x + m[2] * dy.y, m[1] * dy.x + m[3] * dy.y);
    int id = materials[material].textures[slot].texture;
    texture_desc desc = texture_desc(textures[id].page, textures[id].offset_base, textures[id].width_base, textures[id].height_base,
                                     textures[id].levels, textures[id].wrap_s, textures[id].wrap_t, textures[id].nearest);
    texture_footprint footprint = texture_footprint_of(desc, at_dx, at_dy, frame.texture_taps);
#ifdef BN_NATIVE_SAMPLER
    // the kernel's taps, each filtered by the device: anisotropic filters of devices differ, and lavapipe's takes a millisecond a pixel
    int taps = desc.nearest != 0 ? 1 : to_int(footprint.taps);
    real spacing = lit(1.0) / (to_real(taps) + lit(1.0));
    real4 sum = vec4(0.0);
    for (int i = 1; i <= taps; ++i) {
        real along = to_real(i) * spacing - lit(0.5);
        real2 tap = at + footprint.axis * along;
        sum += native_texel(slot, tap, footprint.lod);
    }
    real4 mean = sum / to_real(taps);
    return mean;
#else
    return texture_sample_footprint(desc, at, footprint, to_int(footprint.taps));
#endif
}

struct material_inputs {
    real3 base;
    real alpha, metallic, roughness, occlusion;
    real3 normal_map, emissive, dielectric_f0;
    real dielectric_f90;
    real3 tensor2, tensor4;
};

material_inputs fetch_material(int m, visible_point p)
{
    real4 texel[kGpuTextureSlots]; // one piece of code fetches them all
    for (int slot = 0; slot < kGpuTextureSlots; ++slot)
        if (texture_used(m, slot))
            texel[slot] = fetch_texture(m, slot, p);
    material_inputs r;
    r.base = vec3(materials[m].base_color[0], materials[m].base_color[1], materials[m].base_color[2]);
    r.alpha = materials[m].base_color[3];
    if (texture_used(m, kBaseColorTex)) {
        r.base = r.base * texel[kBaseColorTex].xyz;
        r.alpha = r.alpha * texel[kBaseColorTex].w;
    }
    if (materials[m].uses_color != 0) {
        r.base = r.base * p.color.xyz;
        r.alpha = r.alpha * p.color.w;
    }
    r.metallic = materials[m].metallic;
    r.roughness = materials[m].roughness;
    if (texture_used(m, kMetalRoughTex)) {
        if (materials[m].roughness_fixed == 0)
            r.roughness = r.roughness * texel[kMetalRoughTex].y;
        r.metallic = r.metallic * texel[kMetalRoughTex].z;
    }
    r.normal_map = vec3(0.0, 0.0, 1.0);
    if (texture_used(m, kNormalTex)) {
        real4 t = texel[kNormalTex];
        real scale = materials[m].normal_scale;
        r.normal_map = vec3((t.x * lit(2.0) - lit(1.0)) * scale, (t.y * lit(2.0) - lit(1.0)) * scale, t.z * lit(2.0) - lit(1.0));
    }
    r.occlusion = 1.0;
    if (texture_used(m, kOcclusionTex))
        r.occlusion = lit(1.0) + materials[m].occlusion_strength * (texel[kOcclusionTex].x - lit(1.0));
    r.emissive = vec3(materials[m].emissive[0], materials[m].emissive[1], materials[m].emissive[2]);
    if (texture_used(m, kEmissiveTex))
        r.emissive = r.emissive * texel[kEmissiveTex].xyz;
    r.dielectric_f0 = vec3(materials[m].dielectric_f0[0], materials[m].dielectric_f0[1], materials[m].dielectric_f0[2]);
    r.dielectric_f90 = materials[m].dielectric_f90;
    if (texture_used(m, kSpecularTex)) {
        r.dielectric_f0 = r.dielectric_f0 * texel[kSpecularTex].w;
        r.dielectric_f90 = r.dielectric_f90 * texel[kSpecularTex].w;
    }
    if (texture_used(m, kSpecularColorTex))
        r.dielectric_f0 = r.dielectric_f0 * texel[kSpecularColorTex].xyz;
    r.tensor2 = r.tensor4 = vec3(1.0, 0.0, 0.0);
    if (texture_used(m, kTensor2Tex)) {
        r.tensor2 = texel[kTensor2Tex].xyz + texel[kTensor2RestTex].xyz;
        r.tensor4 = texel[kTensor4Tex].xyz + texel[kTensor4RestTex].xyz;
    }
    return r;
}

struct lobe_shape {
    real sigma_u, sigma_v;
    real2 u;        // its axis, along tangent and bitangent
    real alpha_lin; // perceptual roughness
};

lobe_shape shape_of(int m, material_inputs at)
{
    lobe_shape r;
    real roughness = min(max(at.roughness, lit(0.0)), lit(1.0));
    real alpha = roughness * roughness;
    real sigma = alpha * lit(0.70710678118654752);
    r.sigma_u = r.sigma_v = sigma;
    r.u = vec2(1.0, 0.0);
    r.alpha_lin = at.roughness;
    if (materials[m].anisotropic == 0)
        return r;
    real2 rotation = vec2(materials[m].anisotropy_rotation[0], materials[m].anisotropy_rotation[1]);
    slope_covariance covariance;
    if (frame.override_anisotropy != 0)
        covariance = covariance_from_eta_tensor(roughness, frame.anisotropy, rotation, at.tensor2);
    else
        covariance = covariance_from_tensors(alpha, materials[m].anisotropy_strength, rotation, at.tensor2, at.tensor4);
    slope_axes axes = axes_of_covariance(covariance);
    real trace = covariance.xx + covariance.yy;
    mask mirror = trace <= lit(1e-12); // smooth in every direction: the decomposition's least widths are not for it
    r.sigma_u = select(mirror, sigma, axes.sigma_u);
    r.sigma_v = select(mirror, sigma, axes.sigma_v);
    r.u = axes.u;
    aniso_lobe lobe;
    lobe.u_axis = lobe.v_axis = vec3(0.0);
    lobe.sigma_u = r.sigma_u;
    lobe.sigma_v = r.sigma_v;
    r.alpha_lin = lobe_alpha_lin(lobe);
    return r;
}

aniso_lobe lobe_in_frame(int m, lobe_shape shape, surface_frame f)
{
    aniso_lobe lobe;
    lobe.sigma_u = shape.sigma_u;
    lobe.sigma_v = shape.sigma_v;
    lobe.u_axis = f.t;
    lobe.v_axis = f.b;
    if (materials[m].anisotropic == 0)
        return lobe;
    lobe.u_axis = f.t * shape.u.x + f.b * shape.u.y;
    lobe.v_axis = f.b * shape.u.x - f.t * shape.u.y;
    return lobe;
}

#endif
