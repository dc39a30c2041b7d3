#include "raster/vulkan/lab/lean.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/simd/half.h"
#include "raster/vulkan/forward_shaders.h"
#include "raster/vulkan/lab/lean_lights.h"
#include "raster/vulkan/lab/shaders.h"
#include "shading/surface/lobe_shape.t.h"

namespace burnish {

namespace {

// Techniques in the order of lean.frag.
constexpr const char* kLeanTechniques[] = {
    "split_isotropic", "bent_normal", "major_axis", "major_axis_adaptive", "major_axis_weighted", "lobe_line", "filtered_is",
    "filtered_is_ggx", "mc",          "as_mc"};

// Traits of a material, as in surface.glsl.
constexpr std::int32_t kAnisotropic = 1, kDiffuse = 2, kOneShape = 4, kVertexColors = 8, kTwoSided = 16, kAlphaTest = 32, kUnlit = 64,
                       kMirror = 128, kEmits = 256, kOneEta = 512, kFactorRoughness = 1024, kPhongTable = 2048, kLamps = 4096,
                       kAreas = 8192, kRoundLights = 16384, kCoat = 32768;

struct LeanFrame { // std140: frame.glsl
    glm::mat4 clip_from_world;
    glm::vec4 eye, sky_x, sky_y, sky_z, scale, axis, tables;
};

struct LeanMaterial { // std140: surface.glsl
    glm::vec4 base, dielectric, f0, diffuse, factors, emissive, lobe, grain;
    glm::vec4 place[2 * kTextureSlots];
    glm::vec4 coat;
};
static_assert(sizeof(LeanMaterial) == sizeof(glm::vec4) * (9 + 2 * kTextureSlots));
static_assert(offsetof(LeanMaterial, coat) == sizeof(glm::vec4) * (8 + 2 * kTextureSlots));
constexpr std::uint32_t kTableSamplers = 5;                                       // of set 0: albedo tables and transformed cosines
constexpr std::size_t kMaterialStride = (sizeof(LeanMaterial) + 255) / 256 * 256; // the largest alignment of uniform buffers

// Vertex input: positions, then shading data.
constexpr VkVertexInputBindingDescription kVertexBuffers[] = {{0, 3 * sizeof(float), VK_VERTEX_INPUT_RATE_VERTEX},
                                                              {1, sizeof(ShadingVertex), VK_VERTEX_INPUT_RATE_VERTEX}};
constexpr VkVertexInputAttributeDescription kVertexAttributes[] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                                                   {1, 1, VK_FORMAT_R32G32B32_SFLOAT, offsetof(ShadingVertex, normal)},
                                                                   {2, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(ShadingVertex, tangent)},
                                                                   {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(ShadingVertex, uv0)},
                                                                   {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(ShadingVertex, color)}};

int lean_technique(int technique)
{
    const std::string name = techniques()[static_cast<std::size_t>(technique)].name;
    const auto at = std::find(std::begin(kLeanTechniques), std::end(kLeanTechniques), name);
    return at == std::end(kLeanTechniques) ? -1 : static_cast<int>(at - std::begin(kLeanTechniques));
}

bool used(const MaterialRecord& m, int slot)
{
    return m.textures[slot].texture >= 0;
}

glm::vec3 vec3(const float* v)
{
    return {v[0], v[1], v[2]};
}

// Returns the frame's feature that the stages lack; null: none.
const char* not_of_frame(const FrameDesc& desc, const GpuScene& scene)
{
    const FrameRecord& f = scene.record();
    if (f.extracted_light_count > 0)
        return "extracted lights (EnvironmentOptions::extracted_lights off leaves them in the environment)";
    if (const char* lights = lights_that_lean_lacks(scene); lights)
        return lights;
    if (f.lobe != lobe_with(kDefaultLobe))
        return "lobes other than the default (FrameDesc::brdf, FrameDesc::tilt, FrameDesc::masking)";
    if (desc.dfg_fit != 0 || desc.fresnel != kFresnelSchlick || desc.energy_compensation || f.horizon != 0 || desc.specular_aa ||
        desc.frame_map != 0)
        return "FrameDesc::dfg_fit fit, FrameDesc::fresnel, FrameDesc::energy_compensation, FrameDesc::horizon on under normal maps, "
               "FrameDesc::specular_aa and FrameDesc::frame_map";
    if (desc.seed != 0)
        return "FrameDesc::seed";
    if (desc.technique == "major_axis_adaptive" && desc.major_axis_k != 1.0f)
        return "major_axis_adaptive with another FrameDesc::major_axis_k than 1";
    return nullptr;
}

// Returns the material's first coating that the stages lack; null: none.
const char* not_of_coatings(const MaterialRecord& m)
{
#define BN_COATING(id, bit, strength, lobe)                                                                                                \
    if (bit != kCoating_clearcoat && (m.coatings & (1 << bit)) != 0)                                                                       \
        return #id;
#include "shading/coatings.def"
    return m.coat_spread != 0 ? "clear coats that the spread of their normals widens" : nullptr;
}

const char* not_of_material(const MaterialRecord& m)
{
    if (!m.unlit && lean_technique(m.technique) < 0)
        return techniques()[static_cast<std::size_t>(m.technique)].name;
    if (m.transmission > 0.0f)
        return "materials that let light through";
    if (const char* coating = not_of_coatings(m); coating)
        return coating;
    if (m.film != 0)
        return "thin films";
    if (m.alpha_mode == kAlpha_blend)
        return "blended alpha";
    if (m.parallax != 0 || m.moments == kMomentsOfTilt || m.moments == kMomentsOfAll || m.tilted != 0 || m.tilt_mapped != 0)
        return "heights, tilts and moments of slopes in textures";
    if (m.facets > 0)
        return "normal maps so strong that they are shaded as facets from afar";
    if (used(m, kSpecularTex) || used(m, kSpecularColorTex))
        return "textures of KHR_materials_specular";
    return nullptr;
}

// Checks that the lean stages can draw the frame. Errors: ExitCode::unavailable, naming the missing feature.
Status check_lean(const FrameDesc& desc, const GpuScene& scene)
{
    const std::vector<MaterialRecord>& materials = scene.materials_of_frame();
    const char* missing = not_of_frame(desc, scene);
    for (std::size_t i = 0; !missing && i < materials.size(); ++i)
        missing = not_of_material(materials[i]);
    if (missing)
        return Error{ExitCode::unavailable, "", "lean shader", fmt::format("does not draw {}", missing)};
    return {};
}

class LeanDrawer final : public ForwardDrawer {
  public:
    LeanDrawer(Context& context, Pipelines& pipelines, GpuScene& scene, const RenderInput& input);
    ~LeanDrawer() override;
    LeanDrawer(const LeanDrawer&) = delete;
    LeanDrawer& operator=(const LeanDrawer&) = delete;

    void make_layouts();
    void prepare(const FrameDesc& desc) override; // throws the error of check_lean()
    void draw(VkCommandBuffer c, const NativeImages& native, VkSampleCountFlagBits samples, VkFormat color, const Band& band) override;

  private:
    DeviceImage upload_pairs(const float* pairs, int width, int height, int depth);
    const DeviceImage& slice(int first, int size); // size: texels along n.v
    void fill_materials(const FrameDesc& desc);
    void make_sets();

    Context& context_;
    Pipelines& pipelines_;
    GpuScene& scene_;
    RenderInput input_;
    Buffer positions_, shading_, frame_, materials_, grid_, lights_;
    DeviceImage round_albedo_, width_albedo_, cosines_;
    std::map<int, DeviceImage> slices_;     // by MaterialRecord::albedo_slice
    std::vector<Specialization> constants_; // by material
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> sets_; // for set 0, by material
};

LeanDrawer::LeanDrawer(Context& context, Pipelines& pipelines, GpuScene& scene, const RenderInput& input)
    : context_(context), pipelines_(pipelines), scene_(scene), input_(input)
{
    const DrawTables& t = input.tables;
    std::vector<float> positions;
    for (std::size_t i = 0; i < t.px.size(); ++i)
        positions.insert(positions.end(), {t.px[i], t.py[i], t.pz[i]});
    positions_ = make_filled_buffer(context, positions.data(), positions.size() * sizeof(float), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    shading_ = make_filled_buffer(context, t.shading.data(), t.shading.size() * sizeof(ShadingVertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    frame_ = Buffer(context, sizeof(LeanFrame), Buffer::Place::host, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    round_albedo_ = upload_pairs(input.dfg.pairs.data(), input.dfg.size, input.dfg.size, 1);
    width_albedo_ = upload_pairs(lobe_albedo_pairs(), kLobeAlbedoSize, kLobeAlbedoSize, kLobeAlbedoSize * kLobeAlbedoSize / 4);
    auto sampler = vk_struct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BN_VK(vkCreateSampler(context.device(), &sampler, nullptr, &sampler_));
}

// Makes set 0: frame, material, grid, albedo tables, lights, transformed cosines. Set 1 holds native samplers.
void LeanDrawer::make_layouts()
{
    constexpr VkShaderStageFlags kBoth = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kBoth, nullptr},
        {1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {5, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {6, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {7, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {8, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}};
    auto set = vk_struct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = static_cast<std::uint32_t>(std::size(bindings)), set.pBindings = bindings;
    BN_VK(vkCreateDescriptorSetLayout(context_.device(), &set, nullptr, &set_layout_));
    const VkDescriptorSetLayout sets[] = {set_layout_, pipelines_.native_layout()};
    const VkPushConstantRange range = {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(std::int32_t)};
    auto layout = vk_struct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout.setLayoutCount = 2, layout.pSetLayouts = sets;
    layout.pushConstantRangeCount = 1, layout.pPushConstantRanges = &range;
    BN_VK(vkCreatePipelineLayout(context_.device(), &layout, nullptr, &layout_));
}

LeanDrawer::~LeanDrawer()
{
    vkDestroySampler(context_.device(), sampler_, nullptr);
    vkDestroyDescriptorPool(context_.device(), pool_, nullptr);
    vkDestroyPipelineLayout(context_.device(), layout_, nullptr);
    vkDestroyDescriptorSetLayout(context_.device(), set_layout_, nullptr);
}

// Uploads pairs as halves, which keep three digits.
DeviceImage LeanDrawer::upload_pairs(const float* pairs, int width, int height, int depth)
{
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(depth);
    std::vector<std::uint16_t> two(2 * count);
    for (std::size_t i = 0; i < two.size(); ++i)
        two[i] = float_to_half(pairs[i]);
    ImageShape shape;
    shape.format = VK_FORMAT_R16G16_SFLOAT;
    shape.width = width, shape.height = height, shape.depth = depth;
    return upload_halves(context_, two, shape);
}

const DeviceImage& LeanDrawer::slice(int first, int size)
{
    const auto known = slices_.find(first);
    if (known != slices_.end())
        return known->second;
    const float* const pairs = scene_.lobe_slices().data() + 2 * static_cast<std::size_t>(first);
    return slices_[first] = upload_pairs(pairs, size, size / 2, 1);
}

// Returns the matrix to clip space with y down, with the rows of View; see clip_position (shading/kernels/vertex.k.h).
glm::mat4 clip_matrix(const ViewRecord& v)
{
    const glm::vec3 eye = vec3(v.eye), forward = vec3(v.forward);
    const glm::vec3 x = vec3(v.right) * v.inv_tan_x, y = vec3(v.up) * -v.inv_tan_y;
    const auto row = [&](const glm::vec3& a, float at_eye) { return glm::vec4(a, at_eye - glm::dot(a, eye)); };
    const bool flat = v.orthographic != 0;
    const glm::vec4 z = flat ? row(-v.inv_depth * forward, v.zfar * v.inv_depth) : glm::vec4(0, 0, 0, v.znear);
    const glm::vec4 w = flat ? glm::vec4(0, 0, 0, 1) : row(forward, 0.0f);
    return glm::transpose(glm::mat4(row(x, 0.0f), row(y, 0.0f), z, w));
}

LeanFrame lean_frame(const FrameRecord& f)
{
    const ViewRecord& v = f.view;
    const bool flat = v.orthographic != 0;
    LeanFrame r = {};
    r.clip_from_world = clip_matrix(v);
    r.eye = flat ? glm::vec4(-vec3(v.forward), 0.0f) : glm::vec4(vec3(v.eye), 1.0f);
    r.sky_x = glm::vec4(flat ? glm::vec3(0.0f) : vec3(v.right) / v.inv_tan_x, 0.0f);
    r.sky_y = glm::vec4(flat ? glm::vec3(0.0f) : vec3(v.up) / v.inv_tan_y, 0.0f);
    r.sky_z = glm::vec4(vec3(v.forward), f.background ? f.whole.scale : 0.0f);
    r.scale = glm::vec4(f.specular.scale, f.irradiance.scale, f.box.scale, static_cast<float>(f.specular.levels - 1));
    const float size = static_cast<float>(f.box.size), count = static_cast<float>(std::max(f.grid_count, 1));
    const float term = f.box.levels > 0 ? 0.5f * std::log2(size * size * 0.477464829f / count) : 0.0f;
    r.axis = glm::vec4(f.major_axis_k, f.major_axis_beta, term, static_cast<float>(f.width));
    const float dfg = static_cast<float>(f.dfg_size), lobes = static_cast<float>(f.lobe_albedo_size);
    r.tables = glm::vec4((dfg - 1.0f) / dfg, 0.5f / dfg, (lobes - 1.0f) / lobes, 0.5f / lobes);
    return r;
}

void place_textures(const MaterialRecord& m, const FrameRecord& f, const std::vector<TextureParams>& textures, LeanMaterial& to)
{
    for (int slot = 0; slot < kTextureSlots; ++slot) {
        const TextureBinding& b = m.textures[slot];
        if (b.texture < 0)
            continue;
        const bool nearest = textures[static_cast<std::size_t>(b.texture)].nearest != 0;
        to.place[2 * slot] = glm::vec4(b.transform[0], b.transform[1], b.transform[2], b.transform[3]);
        to.place[2 * slot + 1] =
            glm::vec4(b.transform[4], b.transform[5], nearest ? 1.0f : static_cast<float>(f.texture_taps), b.uv_set != 0 ? 1.0f : 0.0f);
    }
}

// Folds a material's constants.
LeanMaterial lean_material(const MaterialRecord& m, const FrameDesc& desc, const FrameRecord& f, const std::vector<TextureParams>& textures)
{
    LeanMaterial r = {};
    // Reflectances and factors
    r.base = glm::vec4(vec3(m.base_color), m.base_color[3]);
    r.dielectric = glm::vec4(vec3(m.dielectric_f0), m.dielectric_f90);
    r.f0 = glm::mix(r.dielectric, glm::vec4(vec3(m.base_color), 1.0f), m.metallic);
    r.diffuse = glm::vec4(vec3(m.base_color) * (1.0f - m.metallic), m.alpha_cutoff);
    r.factors = glm::vec4(m.metallic, m.roughness, m.normal_scale, m.occlusion_strength);
    r.emissive = glm::vec4(vec3(m.emissive), 0.0f);
    // Lobe: widths, roughness, grain and stretch
    ShadingFrame shapes = {};
    shapes.override_anisotropy = desc.override_anisotropy, shapes.anisotropy = desc.anisotropy;
    const lobe_shape shape = only_lobe_shape(shapes, m);
    const bool one = one_lobe_shape(m);
    const float roughness = std::clamp(one ? shape.roughness : m.roughness, 0.0f, 1.0f);
    r.lobe = glm::vec4(shape.sigma_u, shape.sigma_v, roughness, desc.override_anisotropy ? desc.anisotropy : m.anisotropy_strength);
    const float eta = (shape.sigma_u - shape.sigma_v) / std::max(shape.sigma_u + shape.sigma_v, 1e-20f);
    const float stretch = std::min(eta * std::min(1.5f * std::sqrt(roughness), 1.0f), 0.999f);
    const bool turned = used(m, kTensor2Tex);
    r.grain = glm::vec4(turned ? m.grain[0] : shape.u.x, turned ? m.grain[1] : shape.u.y, stretch,
                        roughness * std::min(std::max(1.2f - eta, 0.0f), 1.0f));
    place_textures(m, f, textures, r);
    r.coat = glm::vec4(m.clearcoat, m.clearcoat_roughness, m.clearcoat_f0, m.clearcoat_normal_scale);
    return r;
}

void LeanDrawer::fill_materials(const FrameDesc& desc)
{
    const std::vector<MaterialRecord>& all = scene_.materials_of_frame();
    const FrameRecord& f = scene_.record();
    constants_.clear();
    if (materials_.bytes() < all.size() * kMaterialStride)
        materials_ = Buffer(context_, all.size() * kMaterialStride, Buffer::Place::host, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const MaterialRecord& m = all[i];
        const LeanMaterial folded = lean_material(m, desc, f, scene_.tables().textures);
        std::memcpy(static_cast<char*>(materials_.data()) + i * kMaterialStride, &folded, sizeof folded);
        std::int32_t textures = 0, traits = 0;
        for (int slot = 0; slot < kTextureSlots; ++slot)
            textures |= used(m, slot) ? 1 << slot : 0;
        const auto trait = [&](bool has, std::int32_t bit) { traits |= has ? bit : 0; };
        trait(m.anisotropic != 0, kAnisotropic);
        trait(m.metallic < 1.0f || used(m, kMetalRoughTex), kDiffuse);
        trait(one_lobe_shape(m), kOneShape);
        trait(m.uses_color != 0, kVertexColors);
        trait(m.double_sided != 0, kTwoSided);
        trait(m.alpha_mode == kAlpha_mask, kAlphaTest);
        trait(m.unlit != 0, kUnlit);
        trait(one_lobe_shape(m) && folded.lobe.x + folded.lobe.y <= 1e-6f, kMirror);
        trait(folded.emissive.x > 0.0f || folded.emissive.y > 0.0f || folded.emissive.z > 0.0f, kEmits);
        trait(desc.override_anisotropy, kOneEta);
        trait(m.roughness_fixed != 0, kFactorRoughness);
        trait(m.phong_slice >= 0, kPhongTable);
        trait(f.light_count > 0, kLamps);
        trait(f.area_light_count > 0, kAreas);
        trait(m.lights_lobe == lobe_with(kRoundLobe), kRoundLights);
        trait((m.coatings >> kCoating_clearcoat & 1) != 0, kCoat);
        const bool gridded = f.grid_count > 0;
        constants_.push_back({std::max(lean_technique(m.technique), 0), gridded ? f.grid_count : m.samples, textures, traits});
    }
}

void LeanDrawer::prepare(const FrameDesc& desc)
{
    if (const Status drawn = check_lean(desc, scene_); !drawn)
        throw VulkanError{drawn.error()};
    const LeanFrame frame = lean_frame(scene_.record());
    std::memcpy(frame_.data(), &frame, sizeof frame);
    const std::vector<GridSample>& grid = scene_.grid();
    if (grid_.bytes() < std::max<std::size_t>(grid.size() * sizeof(GridSample), 1))
        grid_ = Buffer(context_, grid.size() * sizeof(GridSample), Buffer::Place::host);
    if (!grid.empty())
        std::memcpy(grid_.data(), grid.data(), grid.size() * sizeof(GridSample));
    const std::vector<glm::vec4> lights = lean_lights(scene_);
    if (lights_.bytes() < lights.size() * sizeof(glm::vec4))
        lights_ = Buffer(context_, lights.size() * sizeof(glm::vec4), Buffer::Place::host);
    std::memcpy(lights_.data(), lights.data(), lights.size() * sizeof(glm::vec4));
    if (cosines_.view() == VK_NULL_HANDLE)
        cosines_ = upload_cosines(context_, input_);
    fill_materials(desc);
    make_sets();
}

void LeanDrawer::make_sets()
{
    const std::vector<MaterialRecord>& all = scene_.materials_of_frame();
    const auto count = static_cast<std::uint32_t>(std::max<std::size_t>(all.size(), 1)); // at least one, for the sky, which has no material
    vkDestroyDescriptorPool(context_.device(), pool_, nullptr);
    pool_ = VK_NULL_HANDLE;
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * count},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * count},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kTableSamplers * count}};
    auto pool = vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = count, pool.poolSizeCount = static_cast<std::uint32_t>(std::size(sizes)), pool.pPoolSizes = sizes;
    BN_VK(vkCreateDescriptorPool(context_.device(), &pool, nullptr, &pool_));
    const std::vector<VkDescriptorSetLayout> layouts(count, set_layout_);
    sets_.resize(count);
    auto allocate = vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool_, allocate.descriptorSetCount = count, allocate.pSetLayouts = layouts.data();
    BN_VK(vkAllocateDescriptorSets(context_.device(), &allocate, sets_.data()));
    for (std::uint32_t m = 0; m < count; ++m) {
        const bool material = m < all.size();
        const DeviceImage& own =
            material && all[m].albedo_slice >= 0 ? slice(all[m].albedo_slice, kLobeSliceSize) : round_albedo_; // placeholder, never fetched
        const DeviceImage& phong = material && all[m].phong_slice >= 0 ? slice(all[m].phong_slice, kLobeAlbedoSize) : round_albedo_;
        const VkDescriptorBufferInfo buffers[] = {{frame_.handle(), 0, VK_WHOLE_SIZE},
                                                  {material ? materials_.handle() : frame_.handle(), material ? m * kMaterialStride : 0,
                                                   material ? VkDeviceSize{kMaterialStride} : VK_WHOLE_SIZE},
                                                  {grid_.handle(), 0, VK_WHOLE_SIZE},
                                                  {lights_.handle(), 0, VK_WHOLE_SIZE}};
        VkDescriptorImageInfo images[kTableSamplers];
        const DeviceImage* const tables[] = {&round_albedo_, &own, &width_albedo_, &phong, &cosines_};
        for (std::uint32_t i = 0; i < kTableSamplers; ++i)
            images[i] = {sampler_, tables[i]->view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        std::vector<VkWriteDescriptorSet> writes;
        const auto write = [&](std::uint32_t binding, VkDescriptorType type, const VkDescriptorBufferInfo* buffer,
                               const VkDescriptorImageInfo* image) {
            auto w = vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
            w.dstSet = sets_[m], w.dstBinding = binding, w.descriptorCount = 1, w.descriptorType = type;
            w.pBufferInfo = buffer, w.pImageInfo = image;
            writes.push_back(w);
        };
        write(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &buffers[0], nullptr);
        write(1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &buffers[1], nullptr);
        write(2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &buffers[2], nullptr);
        for (std::uint32_t i = 0; i < 4; ++i)
            write(3 + i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, nullptr, &images[i]);
        write(7, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &buffers[3], nullptr);
        write(8, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, nullptr, &images[4]);
        vkUpdateDescriptorSets(context_.device(), static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
    }
}

void LeanDrawer::draw(VkCommandBuffer c, const NativeImages& native, VkSampleCountFlagBits samples, VkFormat color, const Band& band)
{
    auto input = vk_struct<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    input.vertexBindingDescriptionCount = static_cast<std::uint32_t>(std::size(kVertexBuffers)),
    input.pVertexBindingDescriptions = kVertexBuffers;
    input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(std::size(kVertexAttributes));
    input.pVertexAttributeDescriptions = kVertexAttributes;
    const auto use = [&](const GraphicsState& state, const Specialization& constants, std::size_t material, bool culled) {
        vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.graphics(state, constants));
        const VkDescriptorSet both[] = {sets_[material], native.set(material)};
        vkCmdBindDescriptorSets(c, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 2, both, 0, nullptr);
        vkCmdSetCullMode(c, culled ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE);
    };
    const VkBuffer vertices[] = {positions_.handle(), shading_.handle()};
    const VkDeviceSize offsets[] = {0, 0};
    vkCmdBindVertexBuffers(c, 0, 2, vertices, offsets);
    vkCmdBindIndexBuffer(c, scene_.ints().handle(), static_cast<VkDeviceSize>(scene_.places().index_base) * sizeof(std::uint32_t),
                         VK_INDEX_TYPE_UINT32);
    vkCmdPushConstants(c, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof band.first_row, &band.first_row);
    for (const Draw& draw : input_.tables.draws) {
        const auto material = static_cast<std::size_t>(draw.material);
        use({"lean_vert", "lean", color, samples, VK_COMPARE_OP_GREATER, layout_, &input}, constants_[material], material,
            scene_.materials_of_frame()[material].double_sided == 0);
        vkCmdDrawIndexed(c, 3 * draw.triangle_count, 1, 3 * draw.first_triangle, 0, 0);
    }
    use({"lean_sky_vert", "lean_sky", color, samples, VK_COMPARE_OP_GREATER_OR_EQUAL, layout_, &input}, {}, 0,
        false); // where nothing was drawn
    vkCmdDraw(c, 3, 1, 0, 0);
}

std::unique_ptr<ForwardDrawer> make_drawer(Context& context, Pipelines& pipelines, GpuScene& scene, const RenderInput& input)
{
    auto made = std::make_unique<LeanDrawer>(context, pipelines, scene, input);
    made->make_layouts();
    return made;
}

} // namespace

const ForwardShaders* lean_shaders()
{
    static const ForwardShaders shaders = {{
#define BN_STAGE_ROW(NAME) {#NAME, &stage_##NAME},
                                               BN_LAB_STAGES(BN_STAGE_ROW)
#undef BN_STAGE_ROW
                                           },
                                           kTableSamplers,
                                           make_drawer};
    return &shaders;
}

} // namespace burnish
