// Material textures at a visible point; part of stage.glsl.
#ifndef BN_MATERIAL_GLSL
#define BN_MATERIAL_GLSL

#include "shading/lang/frame.h"
#include "shading/kernels/texture_filter.k.h"
#include "shading/kernels/texture_place.k.h"

#define BN_SLOT(slot, at, texture, encoding, power) const int slot = at;
#include "core/scene/material.def"

#ifdef BN_NATIVE_SAMPLER
layout(set = 1, binding = 1) uniform sampler2D native_textures[kTextureSlots]; // the drawn material's

vec4 native_texel(int wanted, vec2 uv, float lod) // not every device indexes samplers by a variable
{
#define BN_SLOT(slot, at, texture, encoding, power)                                                                                   \
    if (wanted == at)                                                                                                                      \
        return textureLod(native_textures[at], uv, lod);
#include "core/scene/material.def"
    return vec4(0.0);
}
#endif

layout(constant_id = 4) const int kUsedTextures = -1; // one material: a bit per used slot; -1: any material, see its record

bool texture_used(material_ref material, int slot)
{
    return kUsedTextures >= 0 ? (kUsedTextures >> slot & 1) != 0 : materials[material].textures[slot].texture >= 0;
}

texture_desc desc_of_texture(int id)
{
    return texture_desc(textures[id].page, textures[id].offset_base, textures[id].width_base, textures[id].height_base, textures[id].levels,
                        textures[id].wrap_s, textures[id].wrap_t, textures[id].nearest);
}
texture_desc texture_desc_of(int f, material_ref material, int slot) { return desc_of_texture(materials[material].textures[slot].texture); }

real4 texel_at_level(texture_one_level t, int slot, real2 uv)
{
#ifdef BN_NATIVE_SAMPLER
    return native_texel(slot, uv, t.lod);
#else
    return texture_sample_level(t, uv);
#endif
}

// Returns a slot's filtered value at visible point p.
real4 fetch_texture(material_ref material, int slot, visible_point p)
{
    texture_place place = texture_place_of(materials[material].textures[slot], p);
    texture_desc desc = texture_desc_of(0, material, slot);
    texture_footprint footprint = texture_footprint_of(desc, place.dx, place.dy, frame.texture_taps);
#ifdef BN_NATIVE_SAMPLER
    // Take the kernel's taps, each filtered by the device. Anisotropic filters differ between devices, and lavapipe's is
    // very slow.
    int taps = desc.nearest != 0 ? 1 : to_int(footprint.taps);
    real spacing = lit(1.0) / (to_real(taps) + lit(1.0));
    real4 sum = vec4(0.0);
    for (int i = 1; i <= taps; ++i) {
        real along = to_real(i) * spacing - lit(0.5);
        real2 tap = place.uv + footprint.axis * along;
        sum += native_texel(slot, tap, footprint.lod);
    }
    real4 mean = sum / to_real(taps);
    return mean;
#else
    return texture_sample_footprint(desc, place.uv, footprint, to_int(footprint.taps));
#endif
}

real4 texel_beside(int f, material_ref m, int slot, visible_point p)
{
    return fetch_texture(m, slot, p);
}

struct texture_fetches {
    real4 texel[kTextureSlots]; // valid for used slots
};

texture_fetches textures_at(int f, material_ref m, visible_point p)
{
    texture_fetches t; // a single call site fetches all slots
    if (materials[m].textured == 0)
        return t;
    for (int slot = 0; slot < kTextureSlots; ++slot)
        if (texture_used(m, slot))
            t.texel[slot] = fetch_texture(m, slot, p);
    return t;
}
real4 texel_of(texture_fetches t, int slot) { return t.texel[slot]; }

#endif
