#include "raster/frame/upload.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "raster/frame/bodies.h"
#include "raster/frame/far_normals.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/anisotropy.h"
#include "shading/bake/mip/light_picture.h"

namespace burnish {

namespace {

void put(float& to, float from)
{
    to = from;
}
void put(int& to, bool from)
{
    to = from;
}
void put(int& to, AlphaMode from)
{
    to = static_cast<int>(from);
}
// Returns the tilts of material and frame together, in radians. Clamped to 80 degrees.
glm::vec2 tilt_rad(const glm::vec2& material_deg, const FrameDesc& desc)
{
    const auto most = static_cast<float>(glm::radians(80.0));
    return glm::clamp(glm::radians(material_deg) + desc.tilt_rad, -most, most);
}

template <int kCount> void put(float (&to)[kCount], const glm::vec<kCount, float>& from)
{
    for (int i = 0; i < kCount; ++i)
        to[i] = from[i];
}

bool above_zero(float x)
{
    return x > 0.0f;
}

bool above_zero(const glm::vec3& v)
{
    return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f;
}

MaterialRecord material_record(const Material& m)
{
    MaterialRecord r = {};
#define BN_FACTOR(kind, name, fallback, path, least, most) put(r.name, m.name);
#define BN_FLAG(kind, name, path) put(r.name, m.name);
#define BN_CHOICE(type, name, words, path) put(r.name, m.name);
#include "core/scene/material.def"
    const float f = (m.ior - 1.0f) / (m.ior + 1.0f);
    for (int i = 0; i < 3; ++i) {
        r.emissive[i] = m.emissive[i] * m.emissive_strength;
        r.dielectric_f0[i] = std::min(f * f * m.specular_color[i], 1.0f) * m.specular; // KHR_materials_specular
    }
    r.dielectric_f90 = m.specular;
    const float coat = (m.clearcoat_ior - 1.0f) / (m.clearcoat_ior + 1.0f);
    r.clearcoat_f0 = m.clearcoat_ior == 1.5f ? 0.04f : coat * coat; // glTF's own to the bit
    r.grain[0] = static_cast<float>(det_cos(static_cast<double>(m.anisotropy_rotation)));
    r.grain[1] = static_cast<float>(det_sin(static_cast<double>(m.anisotropy_rotation)));
    r.anisotropic = m.anisotropy_strength > 0.0f || m.tilt_tex.used();
    r.tilt_mapped = m.tilt_tex.used();
    r.emitter = m.emitter;
    r.parallax = m.has_height_map;
#define BN_COATING(id, at, strength, lobe) r.coatings |= above_zero(m.strength) && !m.unlit ? 1 << at : 0;
#include "shading/coatings.def"
    r.film = m.iridescence > 0.0f && !m.unlit;
    r.conductor = m.conductor_eta != glm::vec3(0.0f) || m.conductor_k != glm::vec3(0.0f);
    return r;
}

LightRecord light_record(const PunctualLight& l)
{
    LightRecord r = {};
#define BN_LIGHT_FIELD(kind, name, initial) put(r.name, l.name);
#include "core/scene/light.def"
    return r;
}

AreaLightRecord area_light_record(const PlacedAreaLight& l)
{
    static_assert(kMostAreaCorners == kMostAreaPoints);
    AreaLightRecord r = {};
#define BN_AREA_FIELD(kind, name, initial) put(r.name, l.name);
#include "core/scene/area_light.def"
    r.shape = static_cast<int>(l.shape), r.corners = l.point_count;
    for (int i = 0; i < l.point_count; ++i)
        for (int c = 0; c < 3; ++c)
            r.points[3 * i + c] = l.points[i][c];
    r.picture = l.texture;
    std::fill(std::begin(r.mean), std::end(r.mean), 1.0f);
    return r;
}

// Returns true if every texel of the map has alpha 1.
bool texels_are_opaque(const Scene& scene, const TextureRef& map)
{
    const Image& image = scene.images[static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(map.texture)].image)];
    const std::size_t channels = static_cast<std::size_t>(image.channels);
    if (channels != 2 && channels != 4)
        return true;
    const std::size_t texels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < texels; ++i)
        if (!(texel_channel(image, i, channels - 1) >= 1.0f))
            return false;
    return true;
}

// Vulkan 1.3, "Standard sample locations", in 1/16 pixel.
struct Position {
    std::int8_t x, y;
};
constexpr Position kSamples1[] = {{8, 8}};
constexpr Position kSamples2[] = {{12, 12}, {4, 4}};
constexpr Position kSamples4[] = {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
constexpr Position kSamples8[] = {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
constexpr Position kSamples16[] = {{9, 9},  {7, 5}, {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                                   {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};

} // namespace

TextureParams texture_params(const TexturePyramid& p)
{
    TextureParams t = {};
    t.texels = p.texels.data();
    t.width = p.width, t.height = p.height, t.levels = p.levels;
    t.wrap_s = static_cast<std::int32_t>(p.wrap_s), t.wrap_t = static_cast<std::int32_t>(p.wrap_t);
    t.nearest = p.nearest;
    std::copy(std::begin(p.offset), std::end(p.offset), std::begin(t.offset));
    std::copy(std::begin(p.level_width), std::end(p.level_width), std::begin(t.level_width));
    std::copy(std::begin(p.level_height), std::end(p.level_height), std::begin(t.level_height));
    return t;
}

SamplePattern standard_samples(int count)
{
    const Position* table = count == 1 ? kSamples1 : count == 2 ? kSamples2 : count == 4 ? kSamples4 : count == 8 ? kSamples8 : kSamples16;
    BN_CHECK(count == 1 || count == 2 || count == 4 || count == 8 || count == 16);
    SamplePattern p = {};
    p.count = count;
    p.min_x = p.min_y = kSubpixel;
    for (int i = 0; i < count; ++i) {
        p.x16[i] = table[i].x, p.y16[i] = table[i].y;
        p.x[i] = table[i].x * 16, p.y[i] = table[i].y * 16;
        p.min_x = std::min(p.min_x, p.x[i]), p.max_x = std::max(p.max_x, p.x[i]);
        p.min_y = std::min(p.min_y, p.y[i]), p.max_y = std::max(p.max_y, p.y[i]);
    }
    return p;
}

int central_sample(const SamplePattern& p)
{
    const auto far = [&](int s) {
        const int x = p.x[s] - kSubpixel / 2, y = p.y[s] - kSubpixel / 2;
        return x * x + y * y;
    };
    int nearest = 0;
    for (int s = 1; s < p.count; ++s)
        if (far(s) < far(nearest))
            nearest = s;
    return nearest;
}

std::vector<MaterialRecord> material_records(const Scene& scene, const SceneMips& mips, const std::vector<KeptWeights>& kept,
                                             bool overridden)
{
    const std::vector<PyramidKey> keys = used_pyramids(scene, mips, kept);
    std::vector<MaterialRecord> records;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        records.push_back(material_record(scene.materials[i]));
        bind_textures(scene, mips, kept, i, overridden, keys, records.back());
    }
    for (const Primitive& p : scene.primitives)
        if (p.has_color)
            records[static_cast<std::size_t>(p.material)].uses_color = 1;
    for (std::size_t i = 0; i < records.size(); ++i) {
        MaterialRecord& r = records[i];
        const TextureRef& map = scene.materials[i].base_color_tex;
        if (r.alpha_mode == kAlpha_blend && r.base_color[3] >= 1.0f && !r.uses_color && (!map.used() || texels_are_opaque(scene, map)))
            r.alpha_mode = kAlpha_opaque;
    }
    return records;
}

bool any_blends(const std::vector<MaterialRecord>& materials)
{
    return std::any_of(materials.begin(), materials.end(), [](const MaterialRecord& m) { return m.alpha_mode == kAlpha_blend; });
}

std::vector<LightRecord> light_records(const DrawTables& tables)
{
    std::vector<LightRecord> records;
    for (const PunctualLight& l : tables.lights)
        records.push_back(light_record(l));
    return records;
}

// Stores light positions and ranges as columns, for lane code.
void put_light_columns(SceneTables& s)
{
    const std::size_t stride = s.lights.size() + kColumnPad;
    s.light_stride = static_cast<int>(stride);
    s.light_columns.resize(4 * stride);
    for (std::size_t i = 0; i < s.lights.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            s.light_columns[k * stride + i] = s.lights[i].position[k];
        s.light_columns[3 * stride + i] = s.lights[i].directional ? 0.0f : s.lights[i].inv_range2;
    }
}

std::vector<AreaLightRecord> area_light_records(const DrawTables& tables)
{
    std::vector<AreaLightRecord> records;
    for (const PlacedAreaLight& l : tables.area_lights)
        records.push_back(area_light_record(l));
    return records;
}

namespace {

// Makes each area light picture once, as a texture. Numbers these textures after the materials' textures.
void add_light_pictures(const Scene& scene, const Jobs& jobs, SceneTables& s)
{
    std::vector<int> used; // textures in the scene
    for (const AreaLightRecord& l : s.area_lights)
        if (l.picture >= 0 && std::find(used.begin(), used.end(), l.picture) == used.end())
            used.push_back(l.picture);
    std::vector<LightPicture> pictures(used.size());
    jobs.parallel_for(used.size(), [&](std::size_t i, int) {
        const Texture& texture = scene.textures[static_cast<std::size_t>(used[i])];
        pictures[i] = make_light_picture(scene.images[static_cast<std::size_t>(texture.image)]);
    });
    for (AreaLightRecord& l : s.area_lights)
        if (const auto at = std::find(used.begin(), used.end(), l.picture); at != used.end()) {
            put(l.mean, pictures[static_cast<std::size_t>(at - used.begin())].mean);
            l.picture = static_cast<int>(s.pyramids.size() + static_cast<std::size_t>(at - used.begin()));
        }
    for (LightPicture& picture : pictures)
        s.pyramids.push_back(std::make_shared<const TexturePyramid>(std::move(picture.differences)));
}

} // namespace

SceneTables upload_scene(const RenderInput& input)
{
    const Scene& scene = input.scene;
    const SceneMips& mips = input.mips;
    const DrawTables& tables = input.tables;
    const Jobs& jobs = input.jobs;
    SceneTables s;
    const std::vector<KeptWeights> kept = kept_weights_by_material(scene, mips, jobs);
    s.pyramids = make_pyramids(scene, mips, kept, used_pyramids(scene, mips, kept), jobs, input.pyramids);
    s.area_lights = area_light_records(tables);
    add_light_pictures(scene, jobs, s);
    for (const auto& p : s.pyramids)
        s.textures.push_back(texture_params(*p));
    s.materials = material_records(scene, mips, kept, false);
    if (mips.frames_override)
        s.overridden = material_records(scene, mips, kept, true);
    put_bodies(scene, tables, jobs, s.materials, s.overridden);
    s.lights = light_records(tables);
    put_light_columns(s);
    return s;
}

bool tilts(const Scene& scene, const FrameDesc& desc)
{
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [&](const Material& m) { return m.tilt_tex.used() || tilt_rad(m.tilt, desc) != glm::vec2(0.0f); });
}

Status check_frame(const Scene& scene, const FrameDesc& desc)
{
    BN_TRY(check_desc(desc));
    if (!desc.by_material.empty() && desc.by_material.size() != scene.materials.size())
        return Error{ExitCode::usage, "", "",
                     std::to_string(desc.by_material.size()) + " techniques for " + std::to_string(scene.materials.size()) + " materials",
                     "FrameDesc::by_material"};
    const auto has_height_map = [](const Material& m) { return m.has_height_map; };
    if (desc.height_scale != FrameDesc().height_scale && std::none_of(scene.materials.begin(), scene.materials.end(), has_height_map))
        return Error{ExitCode::usage, "", "", "nothing in the scene has a height map", "FrameDesc::height_scale"};
    if (!tilts(scene, desc))
        return {};
    if (const int lobe = lobe_of(desc, true); !(lobe_traits_of(lobe) & kLies_surface))
        return Error{ExitCode::usage, "", "",
                     std::string("lobes of ") + lobe_model(lobe).name + " cannot be tilted, as materials of the scene are; those of " +
                         lobe_model(lobe_with(kTiltedLobe)).name + " can",
                     "FrameDesc::brdf"};
    return {};
}

bool sets_materials(const FrameDesc& desc)
{
    return desc.roughness >= 0.0f || desc.override_anisotropy || desc.frame_map == kFrameOff;
}

Status check_prepared(const SceneMips& mips, const FrameDesc& desc)
{
    if (mips.frames_override || !sets_materials(desc))
        return {};
    return Error{ExitCode::usage, "", "", "no frame of this scene may set roughness or anisotropy, or leave normal maps out",
                 "MipSettings::frames_override"};
}

bool overrides(const Scene& scene, const SceneMips& mips, const FrameDesc& desc)
{
    bool unmapped = false;
    for (std::size_t i = 0; desc.frame_map == kFrameOff && i < scene.materials.size(); ++i)
        unmapped |= is_filtered(scene, scene.materials[i], mips.of(i));
    return desc.roughness >= 0.0f || desc.override_anisotropy || unmapped;
}

std::vector<MaterialRecord> in_frame(std::vector<MaterialRecord> materials, const FrameDesc& desc)
{
    for (MaterialRecord& m : materials) {
        if (desc.roughness >= 0.0f) {
            m.roughness = desc.roughness;
            m.roughness_fixed = 1;
        }
        if (desc.override_anisotropy)
            m.anisotropic = desc.anisotropy != 0.0f || m.moments != kNoMoments;
        if (sets_materials(desc))
            m.keeps = m.facets = 0; // facets belong to the material's roughness and normals
        if (m.frame_map < 0 || desc.frame_map == kFrameOff)
            m.frame_map = desc.frame_map;
        if (desc.frame_map == kFrameOff) {
            // Drop normal maps, and moments made from normals
            m.textures[kNormalTex].texture = m.textures[kCoatNormalTex].texture = -1;
            if (m.moments != kNoMoments && !m.tilt_mapped)
                m.moments = kMomentsUnseen;
        }
        m.parallax_depth = m.height_scale * desc.height_scale;
        m.parallax = m.parallax && m.textures[kNormalTex].texture >= 0 && m.parallax_depth > 0.0f;
        // Tabulate the tilt as cosines, sines and slopes
        const glm::vec2 tilt = tilt_rad({m.tilt[0], m.tilt[1]}, desc);
        m.tilted = m.tilt_mapped || tilt != glm::vec2(0.0f);
        for (int i = 0; i < 2; ++i) {
            m.tilt_cos[i] = static_cast<float>(det_cos(static_cast<double>(tilt[i])));
            m.tilt_sin[i] = static_cast<float>(det_sin(static_cast<double>(tilt[i])));
        }
        m.tilt_slope[0] = m.tilt_sin[1] / m.tilt_cos[1];
        m.tilt_slope[1] = -m.tilt_sin[0] / (m.tilt_cos[0] * m.tilt_cos[1]);
    }
    return materials;
}

} // namespace burnish
