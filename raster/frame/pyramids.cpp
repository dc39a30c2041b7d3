#include "raster/frame/pyramids.h"

#include <algorithm>
#include <tuple>

#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/slopes.h"

namespace burnish {

namespace {

struct TextureUse {
    TextureSlot slot;
    TextureRef Material::*ref;
    TextureEncoding encoding;
    int tensor_power;
};
constexpr TextureUse kTextureUses[kTextureSlots] = {
#define BN_SLOT(slot, at, texture, encoding, power) {slot, &Material::texture, TextureEncoding::encoding, power},
#include "core/scene/material.def"
};

bool alike(const Scene& scene, const TextureRef& a, const TextureRef& b)
{
    if (!a.used() || !b.used() || a.uv_set != b.uv_set || a.uv_transform != b.uv_transform)
        return false;
    const Texture &s = scene.textures[static_cast<std::size_t>(a.texture)], &t = scene.textures[static_cast<std::size_t>(b.texture)];
    return s.wrap_s == t.wrap_s && s.wrap_t == t.wrap_t && s.nearest == t.nearest;
}

struct Moments {
    int kind = kNoMoments;
    const TextureRef* place = nullptr;  // where they lie
    const TextureRef* slopes = nullptr; // of tilts or normals
    bool direction = false;             // a map of directions lies there too
};
Moments moments_of(const Scene& scene, const Material& m, bool overridden)
{
    Moments r;
    const bool tilt = m.tilt_tex.used();
    // a grain that lies otherwise than the normals weighs more than how they differ
    const bool normals =
        !tilt && m.lean && m.normal_tex.used() && (!m.anisotropy_tex.used() || alike(scene, m.normal_tex, m.anisotropy_tex));
    r.slopes = tilt ? &m.tilt_tex : normals ? &m.normal_tex : nullptr;
    r.place = r.slopes ? r.slopes : &m.anisotropy_tex;
    r.direction = alike(scene, *r.place, m.anisotropy_tex);
    if (!overridden && tilt && r.direction && !m.metallic_roughness_tex.used())
        r.kind = kMomentsOfAll;
    else if (r.slopes)
        r.kind = kMomentsOfTilt;
    return r;
}

float slope_scale(const Material& m)
{
    return m.tilt_tex.used() ? m.tilt_scale : m.normal_scale;
}

// The first material with the same moments.
std::int32_t owner_of(const Scene& scene, std::size_t material, bool overridden)
{
    const auto content = [&](const Material& m) {
        const Moments of = moments_of(scene, m, overridden);
        return std::tuple(of.kind, of.slopes ? of.slopes->texture : kNone, of.slopes == &m.tilt_tex,
                          of.direction ? m.anisotropy_tex.texture : kNone, slope_scale(m), m.roughness, m.anisotropy_strength,
                          m.anisotropy_rotation);
    };
    const auto wanted = content(scene.materials[material]);
    const auto found =
        std::find_if(scene.materials.begin(), scene.materials.end(), [&](const Material& m) { return content(m) == wanted; });
    return static_cast<std::int32_t>(found - scene.materials.begin());
}

// What a slot of a material holds, and where it lies.
struct Held {
    PyramidKey key;
    const TextureRef* place;
};
std::optional<Held> held_by(const Scene& scene, std::size_t material, const TextureUse& use, bool overridden)
{
    const Material& m = scene.materials[material];
    const Moments moments = use.tensor_power ? moments_of(scene, m, overridden) : Moments{};
    if (moments.kind != kNoMoments)
        return Held{{moments.place->texture, use.encoding, use.tensor_power, moments.kind, owner_of(scene, material, overridden)},
                    moments.place};
    const TextureRef& ref = m.*use.ref;
    return ref.used() ? std::optional(Held{{ref.texture, use.encoding, use.tensor_power}, &ref}) : std::nullopt;
}

const Image* image_of(const Scene& scene, const TextureRef* ref)
{
    if (!ref)
        return nullptr;
    return &scene.images[static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(ref->texture)].image)];
}

Image moments_image(const Scene& scene, const Texture& sampler, const PyramidKey& key)
{
    const Material& m = scene.materials[static_cast<std::size_t>(key.material)];
    const Moments of = moments_of(scene, m, key.moments != kMomentsOfAll);
    const SlopeMaps maps = {image_of(scene, of.slopes),
                            image_of(scene, of.direction ? &m.anisotropy_tex : nullptr),
                            sampler.wrap_s,
                            sampler.wrap_t,
                            sampler.nearest,
                            !m.tilt_tex.used()};
    return slope_moments(maps, {slope_scale(m), key.moments == kMomentsOfAll, m.roughness, m.anisotropy_strength, m.anisotropy_rotation},
                         key.tensor_power);
}

} // namespace

std::vector<PyramidKey> used_pyramids(const Scene& scene)
{
    std::vector<PyramidKey> keys;
    for (const bool overridden : {false, true})
        for (std::size_t i = 0; i < scene.materials.size(); ++i)
            for (const TextureUse& use : kTextureUses)
                if (const std::optional<Held> held = held_by(scene, i, use, overridden);
                    held && std::find(keys.begin(), keys.end(), held->key) == keys.end())
                    keys.push_back(held->key);
    return keys;
}

void bind_textures(const Scene& scene, std::size_t material, bool overridden, const std::vector<PyramidKey>& keys, MaterialRecord& to)
{
    for (const TextureUse& use : kTextureUses) {
        TextureBinding& b = to.textures[use.slot];
        b = {};
        b.texture = -1;
        const std::optional<Held> held = held_by(scene, material, use, overridden);
        if (!held)
            continue;
        b.texture = static_cast<int>(std::find(keys.begin(), keys.end(), held->key) - keys.begin());
        b.uv_set = held->place->uv_set;
        for (int c = 0; c < 3; ++c)
            b.transform[2 * c] = held->place->uv_transform[c][0], b.transform[2 * c + 1] = held->place->uv_transform[c][1];
        to.textured = 1;
    }
    to.moments = moments_of(scene, scene.materials[material], overridden).kind;
    to.anisotropic |= to.moments != kNoMoments;
}

TexturePyramid make_pyramid(const Scene& scene, const PyramidKey& key)
{
    const Texture& texture = scene.textures[static_cast<std::size_t>(key.texture)];
    const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
    if (key.moments != kNoMoments)
        return make_texture_pyramid(moments_image(scene, texture, key), texture, key.encoding);
    if (key.tensor_power != 0)
        return make_texture_pyramid(anisotropy_tensor(image, key.tensor_power), texture, key.encoding);
    return make_texture_pyramid(image, texture, key.encoding);
}

} // namespace burnish
