// Runs a compute shader once over a file of floats: run_compute SHADER.spv FILE INVOCATIONS DEVICE. Binding 0 is the file's floats, which
// the shader changes in place. Exit code 77: no such device.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "raster/vulkan/context.h"

using namespace burnish;

namespace {

std::vector<char> bytes_of(const char* path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void run(Context& context, const std::vector<char>& shader, std::vector<char>& values, std::uint32_t invocations)
{
    VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    auto set_info = vk_struct<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set_info.bindingCount = 1, set_info.pBindings = &binding;
    VkDescriptorSetLayout set_layout;
    BN_VK(vkCreateDescriptorSetLayout(context.device(), &set_info, nullptr, &set_layout));
    auto layout_info = vk_struct<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout_info.setLayoutCount = 1, layout_info.pSetLayouts = &set_layout;
    VkPipelineLayout layout;
    BN_VK(vkCreatePipelineLayout(context.device(), &layout_info, nullptr, &layout));
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    auto pool_info = vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool_info.maxSets = 1, pool_info.poolSizeCount = 1, pool_info.pPoolSizes = &size;
    VkDescriptorPool pool;
    BN_VK(vkCreateDescriptorPool(context.device(), &pool_info, nullptr, &pool));
    auto allocate = vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool, allocate.descriptorSetCount = 1, allocate.pSetLayouts = &set_layout;
    VkDescriptorSet set;
    BN_VK(vkAllocateDescriptorSets(context.device(), &allocate, &set));

    const Buffer buffer(context, values.size(), Buffer::Place::host);
    std::memcpy(buffer.data(), values.data(), values.size());
    const VkDescriptorBufferInfo whole = {buffer.handle(), 0, VK_WHOLE_SIZE};
    auto write = vk_struct<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set, write.descriptorCount = 1, write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, write.pBufferInfo = &whole;
    vkUpdateDescriptorSets(context.device(), 1, &write, 0, nullptr);

    auto module_info = vk_struct<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    module_info.codeSize = shader.size(), module_info.pCode = reinterpret_cast<const std::uint32_t*>(shader.data());
    VkShaderModule module;
    BN_VK(vkCreateShaderModule(context.device(), &module_info, nullptr, &module));
    auto info = vk_struct<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    info.stage = vk_struct<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT, info.stage.module = module, info.stage.pName = "main", info.layout = layout;
    VkPipeline pipeline;
    BN_VK(vkCreateComputePipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));

    VkCommandBuffer commands = context.begin();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    vkCmdDispatch(commands, invocations, 1, 1);
    context.submit(commands);
    std::memcpy(values.data(), buffer.data(), values.size());

    vkDestroyPipeline(context.device(), pipeline, nullptr), vkDestroyShaderModule(context.device(), module, nullptr);
    vkDestroyDescriptorPool(context.device(), pool, nullptr), vkDestroyPipelineLayout(context.device(), layout, nullptr);
    vkDestroyDescriptorSetLayout(context.device(), set_layout, nullptr);
}

} // namespace

int main(int count, char** words)
{
    if (count != 5) {
        std::fprintf(stderr, "usage: run_compute SHADER.spv FILE INVOCATIONS DEVICE\n");
        return 2;
    }
    try {
        const std::vector<char> shader = bytes_of(words[1]);
        std::vector<char> values = bytes_of(words[2]);
        VulkanOptions options;
        options.device = words[4];
        Context context(options);
        run(context, shader, values, static_cast<std::uint32_t>(std::atoi(words[3])));
        std::ofstream(words[2], std::ios::binary).write(values.data(), static_cast<std::streamsize>(values.size()));
    } catch (const VulkanError& e) {
        std::fprintf(stderr, "%s\n", e.error.reason.c_str());
        return e.error.code == ExitCode::unavailable ? 77 : 1;
    }
}
