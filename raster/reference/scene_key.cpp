#include "raster/reference/scene_key.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "raster/frame/far_normals.h"
#include "raster/frame/frame_record.h"
#include "raster/reference/sobol.h"
#include "shading/bake/mip/settings.h"
#include "shading/bake/mipnet/weights.h"

namespace burnish {
namespace {

constexpr std::uint32_t kReferenceVersion = 6; // raise it when the same options give other samples

class Key {
  public:
    template <class... T> void add(const T&... values) { (bytes(&values, sizeof values), ...); }
    template <class T> void column(const T* data, std::size_t count)
    {
        add(count);
        bytes(data, count * sizeof(T));
    }
    std::uint64_t value() const { return hash_; }

  private:
    void bytes(const void* data, std::size_t size) { hash_ = hash_bytes(data, size, hash_); }

    std::uint64_t hash_ = 0;
};

// Adds records that shading reads. They consist of 32-bit numbers without padding, so a new field becomes part of the key automatically.
template <class T> void add_records(Key& key, const std::vector<T>& records)
{
    key.column(records.data(), records.size());
}

void add_textures(Key& key, const Scene& scene)
{
    for (const Texture& t : scene.textures)
        key.add(t.image, t.wrap_s, t.wrap_t, t.nearest);
    for (const Image& i : scene.images) {
        key.add(i.width, i.height, i.channels, i.type);
        key.column(i.bytes.data(), i.bytes.size());
    }
    for (const Material& m : scene.materials) // images of the records' textures
        key.add(
#define BN_TEXTURE(name, path) m.name.texture,
#include "core/scene/material.def"
            0);
}

// Textures hold the maps of mip filters. Add the filters' settings.
void add_filters(Key& key, const Scene& scene, const SceneMips& mips)
{
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (const MaterialMips& m = mips.of(i); makes_lobes(m.filter))
            key.add(m.filter, m.kappa, m.gains, m.lobe);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (const MaterialMips& m = mips.of(i); m.coupled || m.kaiser)
            key.add('c', i, m.coupled, m.kaiser);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (!mips.of(i).facets)
            key.add('f', i);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (const MaterialMips& m = mips.of(i); m.net)
            key.add(mipnet::net_hash(*m.net));
    if (mips.baked)
        for (const MipLevels& levels : mips.baked->materials)
            for (const MipLevel& level : levels.levels)
                key.add(level.gain), key.column(level.texels.data(), level.texels.size());
    if (mips.baked)
        for (const MapLevels& levels : mips.baked->maps)
            for (const std::vector<std::uint16_t>& level : levels.levels)
                key.column(level.data(), level.size());
}

void add_tables(Key& key, const DrawTables& t)
{
    for (const Column<float>* c : {&t.px, &t.py, &t.pz})
        key.column(c->data(), c->size());
    key.column(t.shading.data(), t.shading.size());
    key.column(t.indices.data(), t.indices.size());
    key.column(t.triangle_material.data(), t.triangle_material.size());
}

} // namespace

FrameDesc reference_desc(FrameDesc desc)
{
    const FrameDesc defaults;
    if (desc.area_way != kAreaWay_off) // the method matters to techniques only
        desc.area_way = defaults.area_way;
    desc.light_samples = defaults.light_samples;
    desc.technique = "mc", desc.samples = 1, desc.by_material.clear(), desc.msaa = 1, desc.tile_size = defaults.tile_size;
    for (const ParameterInfo& p : parameters())
        if (!reads("reference", p))
            static_cast<void>(set_parameter(desc, p, p.fallback)); // in its range
    return desc;
}

std::uint64_t reference_key(const RenderInput& input, const FrameDesc& d, const ReferenceOptions& options)
{
    Key key;
    key.add(kReferenceVersion);
    FrameRecord frame = frame_record(input, reference_desc(d));
    frame.specular = frame.irradiance = {}; // the reference reads the full environment, with or without extracted lights
    frame.whole.levels = 1;
    const int extracted_lights = std::exchange(frame.extracted_light_count, 0);
    std::fill(std::begin(frame.extracted_lights), std::end(frame.extracted_lights), ExtractedLightRecord{});
    frame.ltc = {};
    add_records(key, std::vector<FrameRecord>{frame});
    const std::vector<KeptWeights> kept = kept_weights_by_material(input.scene, input.mips, input.jobs);
    add_records(key, in_frame(material_records(input.scene, input.mips, kept, overrides(input.scene, input.mips, d)), d));
    add_records(key, light_records(input.tables));
    add_records(key, area_light_records(input.tables));
    add_textures(key, input.scene);
    add_filters(key, input.scene, input.mips);
    add_tables(key, input.tables);
    const CubeMap& picture = input.environment.picture();
    key.column(picture.texels.data(), 4 * picture.level_texels(0));
    key.column(input.dfg.pairs.data(), input.dfg.pairs.size());
    key.add(options.mode, options.strategy, options.mode == ReferenceMode::path ? options.bounces : 0);
    if (options.full_textures) // otherwise equal to the key of earlier checkpoints
        key.add(options.full_textures);
    if (options.own_rays) // they meet edges by another rounding
        key.add(options.own_rays);
    if (options.shades != kPassShades || options.lamps_only)
        key.add(options.shades, options.lamps_only);
    for (int i = 0; options.lamps_only && i < extracted_lights; ++i)
        key.add(frame.extracted_lights[i]);
    if (options.area_lights_only)
        key.add('a');
    if (options.mode != ReferenceMode::direct && !input.tables.area_lights.empty()) // in older versions area lights occluded each other
        key.add('w');
    return key.value();
}

} // namespace burnish
