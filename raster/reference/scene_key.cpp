#include "raster/reference/scene_key.h"

#include <type_traits>

#include "core/base/hash.h"

namespace burnish {
namespace {

constexpr std::uint32_t kReferenceVersion = 3; // raise it when the same options give other samples

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

void add_texture_ref(Key& key, const TextureRef& t)
{
    key.add(t.texture, t.uv_set);
    for (int c = 0; c < 3; ++c)
        key.add(t.uv_transform[c].x, t.uv_transform[c].y);
}

void add_materials(Key& key, const Scene& scene)
{
    for (const Material& m : scene.materials) {
        key.add(m.base_color, m.metallic, m.roughness, m.normal_scale, m.occlusion_strength, m.emissive, m.ior, m.specular,
                m.specular_color, m.anisotropy_strength, m.anisotropy_rotation, m.alpha_mode, m.alpha_cutoff, m.double_sided,
                m.unlit);
        for (const TextureRef* t : {&m.base_color_tex, &m.metallic_roughness_tex, &m.normal_tex, &m.occlusion_tex, &m.emissive_tex,
                                    &m.specular_tex, &m.specular_color_tex, &m.anisotropy_tex})
            add_texture_ref(key, *t);
    }
    for (const Texture& t : scene.textures)
        key.add(t.image, t.wrap_s, t.wrap_t, t.nearest);
    for (const Image& i : scene.images) {
        key.add(i.width, i.height, i.channels, i.type);
        key.column(i.bytes.data(), i.bytes.size());
    }
    for (const Primitive& p : scene.primitives)
        key.add(p.material, p.has_color);
}

void add_tables(Key& key, const DrawTables& t)
{
    for (const Column<float>* c : {&t.px, &t.py, &t.pz})
        key.column(c->data(), c->size());
    key.column(t.shading.data(), t.shading.size());
    key.column(t.indices.data(), t.indices.size());
    key.column(t.triangle_material.data(), t.triangle_material.size());
    for (const PunctualLight& l : t.lights)
        key.add(l.position, l.direction, l.radiant, l.inv_range2, l.spot_scale, l.spot_offset, l.directional);
}

} // namespace

std::uint64_t reference_key(const RenderInput& input, const FrameDesc& d, const ReferenceOptions& options)
{
    Key key;
    key.add(kReferenceVersion);
    add_tables(key, input.tables);
    add_materials(key, input.scene);
    key.add(input.environment.content_hash, input.environment.specular.size, input.environment.specular.scale);
    key.column(input.environment.specular.texels.data(), input.environment.specular.texels.size());
    key.column(input.dfg.texels.data(), input.dfg.texels.size());
    const View& v = d.view;
    key.add(d.width, d.height, v.eye, v.right, v.up, v.forward, v.orthographic, v.tan_half_x, v.tan_half_y, v.znear, v.zfar);
    key.add(d.roughness, d.anisotropy, d.override_anisotropy, d.dfg_fit, d.energy_compensation, d.horizon, d.seed, d.texture_anisotropy,
            d.background, d.tilt_rad);
    key.add(options.mode, options.strategy, options.mode == ReferenceMode::path ? options.bounces : 0);
    return key.value();
}

} // namespace burnish
