// Texture fetches of a material at visible points, in lanes. Textures with the same layout share tap places and weights, as
// the maps of one material mostly do. Then only the texels differ. The bits equal separate fetches.
#pragma once
#include "core/simd/lanes.h"
#include "shading/inputs/cube_sum.h"
#include "shading/kernels/texture_filter.k.h"
#include "shading/kernels/texture_place.k.h"
#include "shading/lang/tables.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct texture_fetches {
    static constexpr int kMostTaps = 16;

    const TextureParams* textures;
    const TextureBinding* bindings; // the material's, by slot
    const visible_point& p;
    int most_taps; // 1 to kMostTaps

    // The plan of the last texture that had to be planned; later textures with the same layout reuse it.
    mutable const TextureBinding* planned = nullptr;
    mutable int count = 0;
    mutable texel_plan plans[2 * kMostTaps];

    texture_fetches(const ShadingFrame& f, const MaterialRecord& m, const visible_point& at)
        : textures(f.textures), bindings(m.textures), p(at), most_taps(f.texture_taps)
    {
    }
};

// Returns true where two bindings give the same taps.
BN_INLINE bool laid_out_alike(const TextureParams* textures, const TextureBinding& a, const TextureBinding& b)
{
    const TextureParams &s = textures[a.texture], &t = textures[b.texture];
    bool alike = s.width == t.width && s.height == t.height && s.levels == t.levels && s.wrap_s == t.wrap_s && s.wrap_t == t.wrap_t &&
                 s.nearest == t.nearest && a.uv_set == b.uv_set;
    for (int i = 0; i < 6; ++i)
        alike = alike && a.transform[i] == b.transform[i];
    return alike;
}

BN_INLINE texture_desc desc_of(const TextureParams& texture)
{
    return {texture.texels, texture.offset, texture.level_width, texture.level_height,
            texture.levels, texture.wrap_s, texture.wrap_t,      texture.nearest};
}

// Plans all taps of a texture. The lane with the longest footprint sets the number of taps.
BN_STAGE void plan_texture(const texture_fetches& t, const TextureBinding& b)
{
    const TextureParams& texture = t.textures[b.texture];
    const texture_desc desc = desc_of(texture);
    const texture_place place = texture_place_of(b, t.p);
    t.planned = &b;
    if (texture.nearest) {
        plan(t.plans[0], texture_nearest_rows(desc, place.uv));
        t.count = 1;
        return;
    }
    const texture_footprint footprint = texture_footprint_of(desc, place.dx, place.dy, t.most_taps);
    float most[kLanes];
    store(most, reduce_max(footprint.taps));
    const texture_taps taps = texture_taps_of(desc, place.uv, footprint);
    const int n = static_cast<int>(most[0]);
    const bool between = any(taps.f > lit(0.0)); // else the coarser level has weight 0, as under magnification
    int count = 0;
    for (int i = 0; i < n; ++i) {
        const texture_tap tap = texture_tap_at(taps, i);
        plan(t.plans[count++], tap.fine);
        if (between)
            plan(t.plans[count++], tap.coarse);
    }
    t.count = count;
}

// Loads and adds the planned taps.
BN_STAGE real4 load_planned(const texture_fetches& t, texel_buffer texels)
{
    texel_acc acc = texel_zero();
    for (int i = 0; i < t.count; ++i)
        acc = texel_add(acc, texels, t.plans[i]);
    return texel_value(acc);
}

BN_INLINE real4 texel_of(const texture_fetches& t, int slot)
{
    const TextureBinding& b = t.bindings[slot];
    if (!t.planned || !laid_out_alike(t.textures, *t.planned, b))
        plan_texture(t, b);
    return load_planned(t, t.textures[b.texture].texels);
}

BN_INLINE texture_desc picture_of(const ShadingFrame& f, int light)
{
    return desc_of(f.textures[f.area_lights[light].picture]);
}
BN_INLINE texture_desc texture_of_frame(const ShadingFrame& f, int texture)
{
    return desc_of(f.textures[texture]);
}
BN_INLINE texture_desc texture_desc_of(const ShadingFrame& f, const MaterialRecord& m, int slot)
{
    return desc_of(f.textures[m.textures[slot].texture]);
}
BN_INLINE real4 texel_at_level(const texture_one_level& t, int, real2 uv)
{
    return texture_sample_level(t, uv);
}

} // namespace BN_ISA_NS
} // namespace burnish
