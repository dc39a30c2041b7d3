#include "raster/vulkan/gpu_scene.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/math/scalar_math.h"
#include "raster/frame/grid_samples.h"
#include "raster/vulkan/bands.h"

namespace burnish {

namespace {

static_assert(kTextureSlots == kGpuTextureSlots && kMaxSamples == kGpuSamples);
static_assert(kInterpolantWords == kGpuInterpolantWords && kMaterialWords == kGpuMaterialWords && kPairWords == kGpuPairWords);
static_assert(sizeof(GpuVertex) == kVertexWords * sizeof(std::uint32_t));

template <class T, std::size_t N> void copy(T (&to)[N], const T (&from)[N]) { std::copy(std::begin(from), std::end(from), std::begin(to)); }

GpuCube gpu_cube(const CubeMap& cube, int page) { return {page, cube.size, cube.levels, cube.scale}; }

GpuMaterial gpu_material(const MaterialRecord& m, const std::vector<TextureParams>& textures)
{
    GpuMaterial r = {};
    copy(r.base_color, m.base_color), copy(r.emissive, m.emissive), copy(r.dielectric_f0, m.dielectric_f0);
    r.metallic = m.metallic, r.roughness = m.roughness;
    r.normal_scale = m.normal_scale, r.occlusion_strength = m.occlusion_strength;
    r.dielectric_f90 = m.dielectric_f90, r.alpha_cutoff = m.alpha_cutoff, r.alpha_mode = m.alpha_mode;
    r.double_sided = m.double_sided, r.unlit = m.unlit, r.textured = m.textured, r.uses_color = m.uses_color;
    r.anisotropic = m.anisotropic, r.roughness_fixed = m.roughness_fixed;
    r.anisotropy_strength = m.anisotropy_strength, copy(r.anisotropy_rotation, m.anisotropy_rotation);
    for (int i = 0; i < kTextureSlots; ++i) {
        const TextureBinding& b = m.textures[i];
        r.textures[i].texture = b.texture ? static_cast<int>(b.texture - textures.data()) : -1;
        r.textures[i].uv_set = b.uv_set;
        copy(r.textures[i].transform, b.transform);
    }
    return r;
}

GpuLight gpu_light(const LightRecord& l)
{
    GpuLight r = {};
    copy(r.position, l.position), copy(r.direction, l.direction), copy(r.radiant, l.radiant);
    r.inv_range2 = l.inv_range2, r.spot_scale = l.spot_scale, r.spot_offset = l.spot_offset, r.directional = l.directional;
    return r;
}

template <class T> Buffer filled(Context& context, const std::vector<T>& table, VkBufferUsageFlags more = 0)
{
    const std::size_t bytes = table.size() * sizeof(T);
    require_limit(context, "SCENE", "maxStorageBufferRange", bytes, context.features().max_buffer);
    return make_filled_buffer(context, table.data(), bytes, more);
}

Buffer texel_page(Context& context, const Column<std::uint16_t>& texels)
{
    return make_filled_buffer(context, texels.data(), texels.size() * sizeof(std::uint16_t), VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
}

} // namespace

int viewport_half(const Features& features)
{
    int half = kGpuViewportHalf;
    while (2 * half > features.max_viewport)
        half /= 2;
    return half;
}

GpuScene::GpuScene(Context& context, const RenderInput& input)
    : input_(input), scene_(upload_scene(input.scene, input.tables, input.jobs)), frame_(context, sizeof(GpuFrame), Buffer::Place::device)
{
    texels_.push_back(texel_page(context, input.environment.specular.texels));
    texels_.push_back(texel_page(context, input.environment.irradiance.texels));
    texels_.emplace_back(context, 0, Buffer::Place::device, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT); // the box chain, some day
    texels_.push_back(texel_page(context, input.dfg.texels));
    texels_.emplace_back(context, 0, Buffer::Place::device, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT); // the lobes' albedo, with compensation
    for (const TexturePyramid& p : scene_.pyramids)
        texels_.push_back(texel_page(context, p.texels));
    upload_pages(context);
    upload_tables(context);
}

void GpuScene::upload_pages(Context& context)
{
    std::vector<std::uint64_t> addresses;
    for (const Buffer& b : texels_)
        addresses.push_back(b.address());
    pages_ = filled(context, addresses);
}

void GpuScene::upload_tables(Context& context)
{
    const DrawTables& t = input_.tables;
    std::vector<float> reals(3 * kMaxGrid); // the grid's place comes first
    const auto append = [](auto& table, const auto* from, std::size_t n) {
        const std::size_t at = table.size();
        table.insert(table.end(), from, from + n);
        return static_cast<int>(at);
    };
    const std::size_t vertices = t.px.size();
    require_limit(context, "SCENE", "maxDrawIndexedIndexValue", vertices, context.features().max_index);
    record_.position_base[0] = append(reals, t.px.data(), vertices);
    record_.position_base[1] = append(reals, t.py.data(), vertices);
    record_.position_base[2] = append(reals, t.pz.data(), vertices);
    record_.shading_base = append(reals, reinterpret_cast<const float*>(t.shading.data()), 16 * vertices);
    std::vector<std::int32_t> ints;
    record_.index_base = append(ints, t.indices.data(), t.indices.size());
    record_.material_base = append(ints, t.triangle_material.data(), t.triangle_count());
    std::vector<GpuTexture> textures;
    for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
        const TextureParams& p = scene_.textures[i];
        textures.push_back({kFirstTexturePage + static_cast<int>(i), p.levels, p.wrap_s, p.wrap_t, p.nearest, append(ints, p.offset, 16),
                            append(reals, p.level_width, 16), append(reals, p.level_height, 16)});
    }
    std::vector<GpuLight> lights;
    for (const LightRecord& l : scene_.lights)
        lights.push_back(gpu_light(l));
    record_.vertex_count = static_cast<int>(vertices), record_.triangle_count = static_cast<int>(t.triangle_count());
    record_.light_count = static_cast<int>(lights.size());
    reals_ = filled(context, reals);
    ints_ = filled(context, ints, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    textures_ = filled(context, textures);
    lights_ = filled(context, lights);
    materials_ = Buffer(context, scene_.materials.size() * sizeof(GpuMaterial), Buffer::Place::device);
}

void GpuScene::prepare(Context& context, const FrameDesc& desc, const SamplePattern& pattern, std::uint32_t setup_capacity)
{
    describe_frame(desc, pattern, setup_capacity);
    record_.clip_unit = 1.0f / static_cast<float>(kSubpixel * viewport_half(context.features()));
    if (find_technique(desc.technique)->sampling == Sampling::grid) {
        if (box_.levels == 0) {
            box_ = box_filtered_chain(input_.environment.specular, input_.jobs);
            texels_[kBoxPage] = texel_page(context, box_.texels);
            upload_pages(context);
        }
        const std::vector<GridSample> grid = grid_samples(desc.samples, desc.technique == "filtered_is_ggx");
        BN_CHECK_OP(grid.size(), <=, kMaxGrid);
        fill_buffer(context, reals_, grid.data(), grid.size() * sizeof(GridSample));
        record_.box = gpu_cube(box_, kBoxPage);
        record_.grid_base = 0, record_.grid_count = static_cast<int>(grid.size());
    }
    if (desc.energy_compensation && record_.lobe_albedo_size == 0) {
        const LobeAlbedoTable albedo = bake_lobe_albedo(kLobeAlbedoSize, input_.jobs);
        texels_[kLobeAlbedoPage] = texel_page(context, albedo.texels);
        upload_pages(context);
        record_.lobe_albedo_page = kLobeAlbedoPage, record_.lobe_albedo_size = albedo.size;
    }
    material_records_.clear();
    for (const MaterialRecord& m : overridden(scene_.materials, desc))
        material_records_.push_back(gpu_material(m, scene_.textures));
    fill_buffer(context, materials_, material_records_.data(), material_records_.size() * sizeof(GpuMaterial));
    fill_buffer(context, frame_, &record_, sizeof record_);
}

void GpuScene::describe_frame(const FrameDesc& desc, const SamplePattern& pattern, std::uint32_t setup_capacity)
{
    GpuFrame& f = record_;
    const ViewParams view = view_params_of(desc.view);
    copy(f.eye, view.eye), copy(f.right, view.right), copy(f.up, view.up), copy(f.forward, view.forward);
    f.inv_tan_x = view.inv_tan_x, f.inv_tan_y = view.inv_tan_y;
    f.znear = view.znear, f.inv_depth = view.inv_depth, f.zfar = view.zfar, f.orthographic = view.orthographic;
    f.width = desc.width, f.height = desc.height, f.msaa = desc.msaa;
    f.center_x = desc.width / 2 * kSubpixel, f.center_y = desc.height / 2 * kSubpixel;
    f.half_width = 0.5f * static_cast<float>(desc.width), f.half_height = 0.5f * static_cast<float>(desc.height);
    copy(f.sample_x, pattern.x), copy(f.sample_y, pattern.y);
    f.sample_min_x = pattern.min_x, f.sample_max_x = pattern.max_x, f.sample_min_y = pattern.min_y, f.sample_max_y = pattern.max_y;
    f.setup_capacity = static_cast<int>(setup_capacity);
    f.specular = gpu_cube(input_.environment.specular, kSpecularPage);
    f.irradiance = gpu_cube(input_.environment.irradiance, kIrradiancePage);
    f.dfg_page = kDfgPage, f.dfg_size = input_.dfg.size;
    f.dfg_fit = desc.dfg_fit, f.energy_compensation = desc.energy_compensation, f.horizon = desc.horizon;
    f.background = desc.background, f.samples = desc.samples, f.texture_taps = desc.texture_anisotropy;
    f.seed = static_cast<int>(desc.seed);
    for (int i = 0; i < 2; ++i) {
        f.tilt_cos[i] = static_cast<float>(det_cos(static_cast<double>(desc.tilt_rad[i])));
        f.tilt_sin[i] = static_cast<float>(det_sin(static_cast<double>(desc.tilt_rad[i])));
    }
    f.tilted = desc.tilt_rad != glm::vec2(0.0f);
    f.major_axis_k = desc.major_axis_k, f.major_axis_beta = desc.major_axis_beta;
    f.override_anisotropy = desc.override_anisotropy, f.anisotropy = desc.anisotropy;
}

} // namespace burnish
