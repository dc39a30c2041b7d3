#include "raster/frame/pyramids.h"

#include <algorithm>
#include <tuple>

#include "core/jobs/activity.h"
#include "core/scene/height_map.h"
#include "raster/frame/coat_normals.h"
#include "raster/frame/colours.h"
#include "raster/frame/far_normals.h"
#include "raster/frame/filtered_textures.h"
#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/filter.h"
#include "shading/bake/mip/map_levels.h"
#include "shading/bake/mip/slopes.h"
#include "shading/bake/mipnet/weights.h"

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

// Returns the reason why two used textures do not place the same texel at the same point. Empty if they do.
const char* what_differs(const Scene& scene, const TextureRef& a, const TextureRef& b)
{
    if (a.uv_set != b.uv_set)
        return "another set of texture coordinates";
    if (a.uv_transform != b.uv_transform)
        return "another transform";
    const Texture &s = scene.textures[static_cast<std::size_t>(a.texture)], &t = scene.textures[static_cast<std::size_t>(b.texture)];
    if (s.wrap_s != t.wrap_s || s.wrap_t != t.wrap_t)
        return "a sampler that goes on otherwise at the border";
    return s.nearest != t.nearest ? "a sampler that interpolates otherwise" : "";
}

bool alike(const Scene& scene, const TextureRef& a, const TextureRef& b)
{
    return a.used() && b.used() && lie_alike(scene, a, b);
}

const Image* image_of(const Scene& scene, const TextureRef& ref)
{
    return ref.used() ? &scene.images[static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(ref.texture)].image)] : nullptr;
}

// Maps that a mip filter reads.
struct FilteredMap {
    TextureRef Material::*ref;
    const char* of;
};
constexpr FilteredMap kFilteredMaps[] = {
    {&Material::normal_tex, "normals"}, {&Material::anisotropy_tex, "anisotropy"}, {&Material::metallic_roughness_tex, "roughness"}};

const FilteredMap* first_map(const Material& m)
{
    const auto used = [&](const FilteredMap& map) { return (m.*map.ref).used(); };
    const auto found = std::find_if(std::begin(kFilteredMaps), std::end(kFilteredMaps), used);
    return found == std::end(kFilteredMaps) ? nullptr : found;
}

const TextureRef* first_filtered(const Material& m)
{
    const FilteredMap* first = first_map(m);
    return first ? &(m.*first->ref) : nullptr;
}

MipMaps maps_of(const Scene& scene, const Material& m)
{
    MipMaps maps;
    maps.normal = image_of(scene, m.normal_tex), maps.direction = image_of(scene, m.anisotropy_tex);
    maps.roughness = image_of(scene, m.metallic_roughness_tex);
    const Texture& sampler = scene.textures[static_cast<std::size_t>(first_filtered(m)->texture)];
    maps.wrap_s = sampler.wrap_s, maps.wrap_t = sampler.wrap_t, maps.nearest = sampler.nearest;
    maps.normal_scale = m.normal_scale, maps.roughness_factor = m.roughness;
    maps.anisotropy_strength = m.anisotropy_strength, maps.anisotropy_rotation = m.anisotropy_rotation;
    return maps;
}

// As `lean`, where a frame leaves the levels of a filter aside.
bool widens(const Scene& scene, const Material& m, const MaterialMips& mips)
{
    if (makes_lobes(mips.filter))
        return is_filtered(scene, m, mips) && gain_of_taps(mips.filter, mips.kappa) > 0.0f;
    return m.lean || mips.filter == kMipFilter_lean;
}

struct Moments {
    int kind = kNoMoments;
    const TextureRef* place = nullptr;  // the texture that places them
    const TextureRef* slopes = nullptr; // tilt map or normal map
    bool direction = false;             // an anisotropy map has the same layout
    bool filtered = false;              // they come from a mip filter's levels
};
Moments moments_of(const Scene& scene, const Material& m, const MaterialMips& mips, bool overridden)
{
    Moments r;
    if (!overridden && is_filtered(scene, m, mips)) {
        r.kind = kMomentsOfAll, r.place = first_filtered(m), r.filtered = true;
        return r;
    }
    const bool tilt = m.tilt_tex.used();
    // a grain that lies otherwise than the normals weighs more than how they differ
    const bool normals = !tilt && widens(scene, m, mips) && m.normal_tex.used() &&
                         (!m.anisotropy_tex.used() || alike(scene, m.normal_tex, m.anisotropy_tex));
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

// The first material of the same content as this one: content(place).
template <class Content> std::int32_t first_alike(std::size_t material, const Content& content)
{
    const auto wanted = content(material);
    std::size_t first = 0;
    while (first < material && !(content(first) == wanted))
        ++first;
    return static_cast<std::int32_t>(first);
}

// The first material with the same moments.
std::int32_t owner_of(const Scene& scene, const SceneMips& all, std::size_t material, bool overridden)
{
    const auto content = [&](std::size_t i) {
        const Material& m = scene.materials[i];
        const MaterialMips& mips = all.of(i);
        const Moments of = moments_of(scene, m, mips, overridden);
        const bool own = makes_lobes(mips.filter);
        const bool gains = has_gains(m, mips);
        const bool of_metal = gains || mips.filter == kMipFilter_teacher; // whose levels are made for a metal or for a dielectric
        return std::tuple(of.kind, of.slopes ? of.slopes->texture : kNone, of.slopes == &m.tilt_tex,
                          of.direction || of.filtered ? m.anisotropy_tex.texture : kNone, slope_scale(m), m.roughness,
                          m.anisotropy_strength, m.anisotropy_rotation, of.filtered, own ? mips.filter : MipFilter{},
                          own ? mips.kappa : 0.0f, mips.net.get(), of_metal ? m.metallic : 0.0f, gains, of.filtered && m.has_height_map,
                          of.filtered ? m.normal_tex.texture : kNone, of.filtered ? m.metallic_roughness_tex.texture : kNone);
    };
    return first_alike(material, content);
}

// Returns the first material with the same normals.
std::int32_t first_with_normals(const Scene& scene, const Material& m)
{
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), [&](const Material& other) {
        return other.normal_tex.texture == m.normal_tex.texture && other.normal_scale == m.normal_scale;
    });
    return static_cast<std::int32_t>(found - scene.materials.begin());
}

// The first material whose normals keep the same light.
std::int32_t first_that_keeps(const Scene& scene, const SceneMips& mips, std::size_t material)
{
    return first_alike(material, [&](std::size_t i) {
        const Material& of = scene.materials[i];
        return std::tuple(of.normal_tex.texture, of.normal_scale, of.roughness, of.metallic_roughness_tex.texture, of.has_height_map,
                          of.unlit, has_gains(of, mips.of(i)));
    });
}

// Returns the first material whose coat's normals spread alike.
std::int32_t first_with_coat(const Scene& scene, const SceneMips& mips, std::size_t material)
{
    return first_alike(material, [&](std::size_t i) {
        const Material& of = scene.materials[i];
        return std::tuple(of.clearcoat_normal_tex.texture, of.clearcoat_normal_scale, coat_gain(of, mips.of(i)));
    });
}

// Contents of a material's texture slot, and the texture that places them.
struct Held {
    PyramidKey key;
    const TextureRef* place;
};
std::optional<Held> held_by(const Scene& scene, const SceneMips& all, const std::vector<KeptWeights>& kept, std::size_t material,
                            const TextureUse& use, bool overridden)
{
    const Material& m = scene.materials[material];
    const MaterialMips& mips = all.of(material);
    const bool normals = use.slot == kNormalTex && m.normal_tex.used() && !overridden && is_filtered(scene, m, mips);
    const Moments moments = use.tensor_power || normals ? moments_of(scene, m, mips, overridden) : Moments{};
    if (moments.kind != kNoMoments)
        return Held{{moments.place->texture, use.encoding, use.tensor_power, moments.kind, owner_of(scene, all, material, overridden),
                     moments.filtered},
                    moments.place};
    const TextureRef& ref = m.*use.ref;
    if (!ref.used())
        return std::nullopt;
    Held held = {{ref.texture, use.encoding, use.tensor_power}, &ref};
    if (use.slot == kNormalTex && kept[material].any)
        held.key.keeps = true, held.key.material = first_that_keeps(scene, all, material);
    if (use.slot == kCoatNormalTex && coat_gain(m, mips) > 0.0f)
        held.key.coat = true, held.key.material = first_with_coat(scene, all, material);
    if (use.slot == kBaseColorTex || use.slot == kMetalRoughTex) {
        held.key.kaiser = mips.kaiser;
        if (held.key.coupled = is_coupled(scene, m, mips, ref); held.key.coupled)
            held.key.material = first_with_normals(scene, m);
    }
    return held;
}

Image moments_image(const Scene& scene, const SceneMips& all, const Texture& sampler, const PyramidKey& key)
{
    const Material& m = scene.materials[static_cast<std::size_t>(key.material)];
    const MaterialMips& mips = all.of(static_cast<std::size_t>(key.material));
    const Moments of = moments_of(scene, m, mips, key.moments != kMomentsOfAll);
    const SlopeMaps maps = {of.slopes ? image_of(scene, *of.slopes) : nullptr,
                            of.direction ? image_of(scene, m.anisotropy_tex) : nullptr,
                            sampler.wrap_s,
                            sampler.wrap_t,
                            sampler.nearest,
                            !m.tilt_tex.used()};
    const bool unit = makes_lobes(mips.filter) && !m.tilt_tex.used() && mips.filter != kMipFilter_leadr;
    return slope_moments(maps,
                         {slope_scale(m), key.moments == kMomentsOfAll, m.roughness, m.anisotropy_strength, m.anisotropy_rotation,
                          unit ? gain_of_taps(mips.filter, mips.kappa) : 0.0f},
                         key.tensor_power);
}

} // namespace

bool is_filtered(const Scene& scene, const Material& m, const MaterialMips& mips)
{
    return makes_lobes(mips.filter) && first_filtered(m) && !m.unlit && why_unfiltered(scene, m, mips).empty();
}

std::string why_unfiltered(const Scene& scene, const Material& m, const MaterialMips& mips)
{
    const FilteredMap* first = makes_lobes(mips.filter) && !m.unlit ? first_map(m) : nullptr;
    if (!first)
        return "";
    if (m.tilt_tex.used())
        return "it has a map of tilts";
    for (const FilteredMap& map : kFilteredMaps)
        if ((m.*map.ref).used())
            if (const char* why = what_differs(scene, m.*first->ref, m.*map.ref); *why)
                return std::string("its map of ") + map.of + " has " + why + " than its map of " + first->of;
    const Image* normals = image_of(scene, m.normal_tex);
    const Grid grid = grid_of(maps_of(scene, m));
    if (m.has_height_map && (normals->width != grid.width || normals->height != grid.height))
        return "its normal map, which holds heights, is smaller than its other maps";
    return "";
}

bool has_gains(const Material& m, const MaterialMips& mips)
{
    return mips.gains && takes_gains(mips.filter) && m.transmission == 0.0f;
}

bool is_metal(const Scene& scene, const Material& m)
{
    if (!m.metallic_roughness_tex.used())
        return m.metallic >= 0.5f;
    const Texture& texture = scene.textures[static_cast<std::size_t>(m.metallic_roughness_tex.texture)];
    const Image& map = scene.images[static_cast<std::size_t>(texture.image)];
    const std::size_t texels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    double sum = 0.0;
    if (map.type == PixelType::u8 && map.channels >= 3) {
        std::uint64_t codes = 0;
        for (std::size_t i = 0; i < texels; ++i)
            codes += std::to_integer<std::uint64_t>(map.bytes[i * static_cast<std::size_t>(map.channels) + 2]);
        sum = static_cast<double>(codes) / 255.0;
    } else {
        for (std::size_t i = 0; i < texels; ++i)
            sum += static_cast<double>(texel_channel(map, i, 2));
    }
    return static_cast<double>(m.metallic) * sum >= 0.5 * static_cast<double>(texels);
}

MipHelp mip_help(const Scene& scene, const Material& m, const MaterialMips& mips, const OptimisedTexels& advance)
{
    return {mips.net.get(), is_metal(scene, m), advance, mips.lobe, mips.gains ? Gains::of_frames : Gains::none};
}

MipSource mip_source(const Scene& scene, const Material& m)
{
    return MipSource(maps_of(scene, m));
}

std::uint64_t source_hash(const MipSource& source, MaterialMips& mips, const Jobs& jobs)
{
    if (mips.source == 0)
        mips.source = source.hash(jobs);
    return mips.source;
}

bool fits(const MipLevels& levels, const MipSource& source, std::uint64_t hash, const Scene& scene, const Material& m,
          const MaterialMips& mips)
{
    const bool optimised = mips.filter == kMipFilter_teacher, metal = optimised && is_metal(scene, m);
    return levels.source == hash && levels.width == source.width() && levels.height == source.height() && levels.filter == mips.filter &&
           (!takes_kappa(mips.filter) || levels.kappa == mips.kappa) &&
           (!mips.net || levels.net == levels_hash(*mips.net, mips.filter, metal)) &&
           (!optimised || (levels.net & 1u) == (metal ? 1u : 0u)) &&
           (!has_gains(m, mips) || levels.gained == gained_of(mips.lobe, is_metal(scene, m)));
}

MaterialLevels filtered_levels(const Scene& scene, const SceneMips& scene_mips, const Jobs& jobs, const OptimisedTexels& advance,
                               const std::vector<bool>* wanted)
{
    MaterialLevels all(scene.materials.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Material& m = scene.materials[i];
        const MaterialMips& mips = scene_mips.of(i);
        if (!is_filtered(scene, m, mips))
            continue;
        const auto owner = static_cast<std::size_t>(owner_of(scene, scene_mips, i, false));
        if (owner != i) {
            all[i] = all[owner];
            continue;
        }
        if (wanted && !(*wanted)[i])
            continue;
        const MipSource source = mip_source(scene, m);
        const auto held = [](const auto& there) { return there && !there->materials.empty(); };
        MaterialMips known = mips;
        const std::uint64_t hash = held(scene_mips.baked) || held(scene_mips.cached) ? source_hash(source, known, jobs) : 0;
        for (const auto& there : {scene_mips.cached, scene_mips.baked})
            for (std::size_t k = 0; there && k < there->materials.size(); ++k)
                if (fits(there->materials[k], source, hash, scene, m, mips))
                    all[i] = std::shared_ptr<const MipLevels>(there, &there->materials[k]);
        const Activity activity("levels of " + levels_name(scene, m, mips));
        if (!all[i])
            all[i] = std::make_shared<const MipLevels>(
                make_mip_levels(source, mips.filter, mips.kappa, jobs, mip_help(scene, m, mips, advance)));
    }
    return all;
}

std::vector<std::size_t> filtered_materials(const Scene& scene, const SceneMips& mips)
{
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (is_filtered(scene, scene.materials[i], mips.of(i)) && static_cast<std::size_t>(owner_of(scene, mips, i, false)) == i)
            found.push_back(i);
    return found;
}

std::string levels_name(const Scene& scene, const Material& m, const MaterialMips& mips)
{
    return material_text(scene, m) + " by " + mip_filters()[static_cast<std::size_t>(mips.filter)].name;
}

std::vector<PyramidKey> used_pyramids(const Scene& scene, const SceneMips& mips, const std::vector<KeptWeights>& kept)
{
    std::vector<PyramidKey> keys;
    for (int overridden = 0; overridden <= (mips.frames_override ? 1 : 0); ++overridden)
        for (std::size_t i = 0; i < scene.materials.size(); ++i)
            for (const TextureUse& use : kTextureUses)
                if (const std::optional<Held> held = held_by(scene, mips, kept, i, use, overridden != 0);
                    held && std::find(keys.begin(), keys.end(), held->key) == keys.end())
                    keys.push_back(held->key);
    return keys;
}

void bind_textures(const Scene& scene, const SceneMips& all, const std::vector<KeptWeights>& kept, std::size_t material, bool overridden,
                   const std::vector<PyramidKey>& keys, MaterialRecord& to)
{
    for (const TextureUse& use : kTextureUses) {
        TextureBinding& b = to.textures[use.slot];
        b = {};
        b.texture = -1;
        const std::optional<Held> held = held_by(scene, all, kept, material, use, overridden);
        if (!held)
            continue;
        b.texture = static_cast<int>(std::find(keys.begin(), keys.end(), held->key) - keys.begin());
        b.uv_set = held->place->uv_set;
        for (int c = 0; c < 3; ++c)
            b.transform[2 * c] = held->place->uv_transform[c][0], b.transform[2 * c + 1] = held->place->uv_transform[c][1];
        to.textured = 1;
    }
    const Material& m = scene.materials[material];
    const MaterialMips& mips = all.of(material);
    const Moments moments = moments_of(scene, m, mips, overridden);
    to.moments = moments.kind;
    to.level_gain = moments.filtered ? gain_of_taps(mips.filter, mips.kappa) : -1.0f;
    to.coat_spread = coat_gain(m, mips) > 0.0f;
    to.frame_map = is_filtered(scene, m, mips) ? kFrameQuaternion : -1;
    to.anisotropic |= to.moments != kNoMoments;
    put_far_normals(scene, m, mips, kept[material], to);
}

namespace {

// Makes a pyramid of a key that is not filtered.
TexturePyramid make_pyramid(const Scene& scene, const SceneMips& mips, const PyramidKey& key)
{
    const Texture& texture = scene.textures[static_cast<std::size_t>(key.texture)];
    if (key.coat) {
        const Material& m = scene.materials[static_cast<std::size_t>(key.material)];
        return coat_pyramid(scene, m, coat_gain(m, mips.of(static_cast<std::size_t>(key.material))));
    }
    const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
    if (key.moments == kNoMoments && key.tensor_power == 0 && !key.keeps) {
        TextureRef ref;
        ref.texture = key.texture;
        const UsedMap map = {key.encoding == TextureEncoding::srgb ? MapPart::base_color : MapPart::metallic_roughness, &ref,
                             key.kaiser ? ColourKernel::kaiser : ColourKernel::box, key.coupled};
        const Material& m = scene.materials[static_cast<std::size_t>(std::max(key.material, 0))];
        if (const MapLevels* given = given_map(scene, mips, m, map))
            return pyramid_of_map(image, texture, *given);
        if (key.coupled || key.kaiser)
            return pyramid_of_map(image, texture, map_levels(scene, m, map, {map.part, map.kernel}, Jobs(1)));
    }
    if (key.keeps)
        return kept_pyramid(scene, scene.materials[static_cast<std::size_t>(key.material)], texture, key.encoding);
    if (key.moments != kNoMoments)
        return make_texture_pyramid(moments_image(scene, mips, texture, key), texture, key.encoding);
    if (key.tensor_power != 0)
        return make_texture_pyramid(anisotropy_tensor(image, key.tensor_power), texture, key.encoding);
    return make_texture_pyramid(image, texture, key.encoding);
}

// Makes the filtered pyramids among the missing ones, by material.
void put_filtered(const Scene& scene, const SceneMips& mips, const std::vector<KeptWeights>& kept, const std::vector<PyramidKey>& keys,
                  const std::vector<std::size_t>& missing, const MaterialLevels& levels, const Jobs& jobs,
                  std::vector<std::shared_ptr<const TexturePyramid>>& pyramids)
{
    for (const std::size_t i : missing) {
        if (!keys[i].filtered || pyramids[i])
            continue;
        std::vector<PyramidKey> together;
        std::vector<std::size_t> places;
        for (const std::size_t k : missing)
            if (keys[k].filtered && keys[k].material == keys[i].material && keys[k].texture == keys[i].texture)
                together.push_back(keys[k]), places.push_back(k);
        std::vector<TexturePyramid> made = filtered_textures(scene, mips, kept[static_cast<std::size_t>(keys[i].material)], together,
                                                             *levels[static_cast<std::size_t>(keys[i].material)], jobs);
        for (std::size_t k = 0; k < places.size(); ++k)
            pyramids[places[k]] = std::make_shared<const TexturePyramid>(std::move(made[k]));
    }
}

} // namespace

void PyramidCache::forget_material(std::int32_t material)
{
    std::erase_if(all, [&](const auto& entry) { return entry.first.material == material; });
}

std::vector<std::shared_ptr<const TexturePyramid>> make_pyramids(const Scene& scene, const SceneMips& mips,
                                                                 const std::vector<KeptWeights>& kept, const std::vector<PyramidKey>& keys,
                                                                 const Jobs& jobs, PyramidCache* cache)
{
    // Take those that are cached
    std::vector<std::shared_ptr<const TexturePyramid>> pyramids(keys.size());
    std::vector<std::size_t> missing;
    std::vector<bool> filtered(scene.materials.size(), false);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (cache)
            if (const auto at = std::find_if(cache->all.begin(), cache->all.end(), [&](const auto& k) { return k.first == keys[i]; });
                at != cache->all.end())
                pyramids[i] = at->second;
        if (pyramids[i])
            continue;
        missing.push_back(i);
        if (keys[i].filtered)
            filtered[static_cast<std::size_t>(keys[i].material)] = true;
    }
    // Make the others
    const MaterialLevels levels = filtered_levels(scene, mips, jobs, {}, &filtered);
    put_filtered(scene, mips, kept, keys, missing, levels, jobs, pyramids);
    jobs.parallel_for(missing.size(), [&](std::size_t k, int) {
        const std::size_t i = missing[k];
        if (!pyramids[i])
            pyramids[i] = std::make_shared<const TexturePyramid>(make_pyramid(scene, mips, keys[i]));
    });
    if (!cache)
        return pyramids;
    cache->all.clear();
    for (std::size_t i = 0; i < keys.size(); ++i)
        cache->all.emplace_back(keys[i], pyramids[i]);
    return pyramids;
}

} // namespace burnish
