#include "raster/vulkan/pipelines.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "core/base/hash.h"
#include "core/jobs/activity.h"
#include "raster/vulkan/bands.h"
#include "raster/vulkan/forward_shaders.h"
#include "raster/vulkan/prune.h"

namespace burnish {

namespace {

static_assert(sizeof(GpuPass) <= 128, "every device takes 128 bytes of push constants");

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

struct SpecializationInfo { // refers to the constants, which must outlive it
    explicit SpecializationInfo(const Specialization& constants)
    {
        for (std::uint32_t i = 0; i < constants.size(); ++i)
            entries.push_back({i, static_cast<std::uint32_t>(i * sizeof(std::int32_t)), sizeof(std::int32_t)});
        info.mapEntryCount = static_cast<std::uint32_t>(entries.size()), info.pMapEntries = entries.data();
        info.dataSize = constants.size() * sizeof(std::int32_t), info.pData = constants.data();
    }
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info = {};
};

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, VkShaderModule module, const VkSpecializationInfo* constants)
{
    auto info = vk_struct<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage = stage, info.module = module, info.pName = "main", info.pSpecializationInfo = constants;
    return info;
}

std::string words_of(const Specialization& constants)
{
    std::string words;
    for (std::int32_t c : constants)
        words += fmt::format(",{}", c);
    return words;
}

} // namespace

Pipelines::Pipelines(Context& context, const VulkanOptions& options) : Pipelines(context)
{
    folder_ = options.shader_folder, shaders_ = options.shaders;
    const VkDevice device = context.device();
    const bool native = options.sampler == VulkanSampler::native;
    require_limit(context, "VulkanOptions::device", "maxPerStageDescriptorStorageBuffers", kBufferBindings, context.features().max_buffers);
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (std::uint32_t i = 0; i < kBindings; ++i)
        bindings.push_back({i, i < kBufferBindings ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                            i <= kSetupsBinding || i == kAreaLightsBinding || i == kPeelBinding
                                ? kStages
                                : VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT},
                            nullptr});
    auto set = vk_struct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = static_cast<std::uint32_t>(bindings.size()), set.pBindings = bindings.data();
    BN_VK(vkCreateDescriptorSetLayout(device, &set, nullptr, &set_layout_));
    if (native)
        make_native_layout(shaders_ ? shaders_->samplers : 0);
    const VkDescriptorSetLayout set_layouts[] = {set_layout_, native_layout_};
    const VkPushConstantRange range = {kStages, 0, sizeof(GpuPass)};
    auto layout = vk_struct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout.setLayoutCount = native ? 2 : 1, layout.pSetLayouts = set_layouts;
    layout.pushConstantRangeCount = 1, layout.pPushConstantRanges = &range;
    BN_VK(vkCreatePipelineLayout(device, &layout, nullptr, &layout_));
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBufferBindings},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kBindings - kBufferBindings}};
    auto pool = vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = 1, pool.poolSizeCount = 2, pool.pPoolSizes = sizes;
    BN_VK(vkCreateDescriptorPool(device, &pool, nullptr, &pool_));
    auto allocate = vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool_, allocate.descriptorSetCount = 1, allocate.pSetLayouts = &set_layout_;
    BN_VK(vkAllocateDescriptorSets(device, &allocate, &set_));
    auto sampler = vk_struct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO); // nearest: stages fetch texels by coordinates
    BN_VK(vkCreateSampler(device, &sampler, nullptr, &sampler_));
}

Pipelines::~Pipelines()
{
    const VkDevice device = context_.device();
    for (const auto& [state, pipeline] : pipelines_of_code_)
        vkDestroyPipeline(device, pipeline, nullptr);
    for (const auto& [code, shader] : modules_of_code_)
        vkDestroyShaderModule(device, shader, nullptr);
    vkDestroySampler(device, sampler_, nullptr);
    vkDestroyDescriptorPool(device, pool_, nullptr);
    vkDestroyPipelineLayout(device, layout_, nullptr);
    vkDestroyDescriptorSetLayout(device, native_layout_, nullptr);
    vkDestroyDescriptorSetLayout(device, set_layout_, nullptr);
}

// Makes set 1, for one material: cubes of the environment and the material's textures. One stage binds them all; every device allows 16.
void Pipelines::make_native_layout(std::uint32_t more_samplers)
{
    const Features& f = context_.features();
    const std::uint32_t bound = kGpuCubes + kTextureSlots + more_samplers;
    require_limit(context_, "VulkanOptions::sampler", "maxPerStageDescriptorSamplers", bound, f.max_samplers);
    require_limit(context_, "VulkanOptions::sampler", "maxPerStageDescriptorSampledImages", bound, f.max_sampled_images);
    const VkDescriptorSetLayoutBinding native[] = {
        {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kGpuCubes, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kTextureSlots, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}};
    auto set = vk_struct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = 2, set.pBindings = native;
    BN_VK(vkCreateDescriptorSetLayout(context_.device(), &set, nullptr, &native_layout_));
}

void Pipelines::know(std::vector<KnownNumber> numbers)
{
    numbers_ = std::move(numbers);
    numbers_key_.clear();
    for (const KnownNumber& n : numbers_)
        numbers_key_ += fmt::format(";{}.{}={}", n.binding, n.offset, n.value);
}

std::string Pipelines::key_of(const std::string& name, const Specialization& constants) const
{
    return name + words_of(constants) + numbers_key_;
}

VkShaderModule Pipelines::module(const std::string& shader, const Specialization& constants)
{
    const std::string key = key_of(shader, constants);
    const auto known = modules_.find(key);
    if (known != modules_.end())
        return known->second;
    const Result<std::vector<std::uint32_t>> words =
        shader_words(shader, folder_, shaders_ ? shaders_->files : std::vector<EmbeddedShader>());
    if (!words)
        throw VulkanError{words.error()};
    const std::vector<std::uint32_t> code = pruned(*words, constants, numbers_);
    const std::uint64_t hash = hash_bytes(code.data(), code.size() * sizeof(std::uint32_t));
    if (const auto same = modules_of_code_.find(hash); same != modules_of_code_.end())
        return modules_[key] = same->second;
    auto info = vk_struct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    info.codeSize = code.size() * sizeof(std::uint32_t), info.pCode = code.data();
    VkShaderModule made = VK_NULL_HANDLE;
    BN_VK(vkCreateShaderModule(context_.device(), &info, nullptr, &made));
    return modules_[key] = modules_of_code_[hash] = made;
}

VkPipeline Pipelines::compute(const std::string& shader, const Specialization& constants)
{
    const std::string key = key_of(shader, constants);
    const auto known = pipelines_.find(key);
    if (known != pipelines_.end())
        return known->second;
    const VkShaderModule code = module(shader, constants);
    const std::string state_of_code = fmt::format("{}{}", static_cast<const void*>(code), words_of(constants));
    if (const auto same = pipelines_of_code_.find(state_of_code); same != pipelines_of_code_.end())
        return pipelines_[key] = same->second;
    const SpecializationInfo specialization(constants);
    auto info = vk_struct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = stage_info(VK_SHADER_STAGE_COMPUTE_BIT, code, &specialization.info);
    info.layout = layout_;
    VkPipeline made = VK_NULL_HANDLE;
    const Activity activity("compiling " + shader);
    BN_VK(vkCreateComputePipelines(context_.device(), context_.pipeline_cache(), 1, &info, nullptr, &made));
    return pipelines_[key] = pipelines_of_code_[state_of_code] = made;
}

VkPipeline Pipelines::graphics(const GraphicsState& state, const Specialization& constants)
{
    const std::string numbers =
        fmt::format("{},{},{}", static_cast<int>(state.color), static_cast<int>(state.samples), static_cast<int>(state.compare));
    const std::string key = key_of(fmt::format("{}+{},{}", state.vertex, state.fragment, numbers), constants);
    const auto known = pipelines_.find(key);
    if (known != pipelines_.end())
        return known->second;
    const VkShaderModule vertex = module(state.vertex, {}), fragment = module(state.fragment, constants);
    const std::string state_of_code =
        fmt::format("{}+{},{}{}", static_cast<const void*>(vertex), static_cast<const void*>(fragment), numbers, words_of(constants));
    if (const auto same = pipelines_of_code_.find(state_of_code); same != pipelines_of_code_.end())
        return pipelines_[key] = same->second;
    const SpecializationInfo specialization(constants);
    const VkPipelineShaderStageCreateInfo stages[] = {stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex, nullptr),
                                                      stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, &specialization.info)};
    const auto none = vk_struct<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    auto assembly = vk_struct<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    auto viewport = vk_struct<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = 1, viewport.scissorCount = 1;
    auto raster = vk_struct<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.cullMode = VK_CULL_MODE_NONE, raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE, raster.lineWidth = 1.0f;
    auto multisample = vk_struct<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    multisample.rasterizationSamples = state.samples;
    auto depth = vk_struct<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    depth.depthTestEnable = VK_TRUE, depth.depthWriteEnable = VK_TRUE, depth.depthCompareOp = state.compare;
    VkPipelineColorBlendAttachmentState all = {};
    all.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    auto blend = vk_struct<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = 1, blend.pAttachments = &all;
    const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_CULL_MODE};
    auto dynamic = vk_struct<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = 3, dynamic.pDynamicStates = dynamic_states;
    auto rendering = vk_struct<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    rendering.colorAttachmentCount = 1, rendering.pColorAttachmentFormats = &state.color;
    rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;
    auto info = vk_struct<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering);
    info.stageCount = 2, info.pStages = stages;
    info.pVertexInputState = state.vertices ? state.vertices : &none, info.pInputAssemblyState = &assembly, info.pViewportState = &viewport;
    info.pRasterizationState = &raster, info.pMultisampleState = &multisample, info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend, info.pDynamicState = &dynamic;
    info.layout = state.layout ? state.layout : layout_;
    VkPipeline made = VK_NULL_HANDLE;
    const Activity activity("compiling " + state.fragment);
    BN_VK(vkCreateGraphicsPipelines(context_.device(), context_.pipeline_cache(), 1, &info, nullptr, &made));
    return pipelines_[key] = pipelines_of_code_[state_of_code] = made;
}

void Pipelines::bind_buffer(Binding binding, const Buffer& buffer)
{
    const VkDescriptorBufferInfo info = {buffer.handle(), 0, VK_WHOLE_SIZE};
    auto write = vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set_, write.dstBinding = binding, write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, write.pBufferInfo = &info;
    vkUpdateDescriptorSets(context_.device(), 1, &write, 0, nullptr);
}

void Pipelines::bind_image(Binding binding, const DeviceImage& image)
{
    const VkDescriptorImageInfo info = {sampler_, image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    auto write = vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set_, write.dstBinding = binding, write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, write.pImageInfo = &info;
    vkUpdateDescriptorSets(context_.device(), 1, &write, 0, nullptr);
}

void Pipelines::bind_set(VkCommandBuffer commands, VkPipelineBindPoint point) const
{
    vkCmdBindDescriptorSets(commands, point, layout_, 0, 1, &set_, 0, nullptr);
}

void Pipelines::push(VkCommandBuffer commands, const GpuPass& pass) const
{
    vkCmdPushConstants(commands, layout_, kStages, 0, sizeof pass, &pass);
}

void Pipelines::dispatch(VkCommandBuffer commands, std::size_t invocations) const
{
    constexpr std::size_t kMaxGroups = 65535; // per direction, on every device; stages count groups over two directions (linear_invocation)
    const std::size_t groups = std::max<std::size_t>((invocations + kGpuGroup - 1) / kGpuGroup, 1);
    const std::size_t rows = (groups + kMaxGroups - 1) / kMaxGroups;
    vkCmdDispatch(commands, static_cast<std::uint32_t>(std::min(groups, kMaxGroups)), static_cast<std::uint32_t>(rows), 1);
    full_barrier(commands);
}

} // namespace burnish
