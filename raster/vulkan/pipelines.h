// Pipelines for the stages: one descriptor set for all stages, shaders by name.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "raster/vulkan/context.h"
#include "raster/vulkan/prune.h"
#include "shading/lang/gpu_records.h"

namespace burnish {

// Bindings in the set, as declared in shading/stages.
enum Binding : std::uint32_t {
    kTexelsBinding,
    kRealsBinding,
    kIntsBinding,
    kFrameBinding,
    kMaterialsBinding,
    kTexturesBinding,
    kLightsBinding,
    kVerticesBinding,
    kSetupsBinding,
    kCountsBinding,
    kDrawBinding,
    kIdsBinding,
    kDepthsBinding,
    kColorBinding,
    kRecordsBinding,
    kLinesBinding,
    kAreaLightsBinding,
    kPeelBinding,
    kBufferBindings,
    kIdImageBinding = kBufferBindings,
    kDepthImageBinding,
    kBindings
};

using Specialization = std::vector<std::int32_t>; // values of constant_id 0, 1, 2...

struct GraphicsState {
    std::string vertex, fragment; // names of shaders
    VkFormat color = VK_FORMAT_UNDEFINED;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkCompareOp compare = VK_COMPARE_OP_GREATER;
    // Layout for shaders that a caller brings, one for equal names. Null: the layout of all stages, which fetch vertices themselves.
    VkPipelineLayout layout = VK_NULL_HANDLE;
    const VkPipelineVertexInputStateCreateInfo* vertices = nullptr;
};

class Pipelines {
  public:
    // Throws ExitCode::unavailable if a stage binds more resources than the device allows.
    Pipelines(Context& context, const VulkanOptions& options);
    ~Pipelines();
    Pipelines(const Pipelines&) = delete;
    Pipelines& operator=(const Pipelines&) = delete;

    VkPipelineLayout layout() const { return layout_; }
    VkDescriptorSetLayout native_layout() const { return native_layout_; } // of set 1, with native samplers: cubes, a material's textures
    // Sets the known numbers. Pipelines made for other numbers stay cached beside the new ones.
    void know(std::vector<KnownNumber> numbers);
    // Returns a pipeline, made on first use and then cached.
    VkPipeline compute(const std::string& shader, const Specialization& constants = {});
    VkPipeline graphics(const GraphicsState& state, const Specialization& constants = {});

    void bind_buffer(Binding binding, const Buffer& buffer);
    void bind_image(Binding binding, const DeviceImage& image);
    void bind_set(VkCommandBuffer commands, VkPipelineBindPoint point) const;
    void push(VkCommandBuffer commands, const GpuPass& pass) const;
    void dispatch(VkCommandBuffer commands, std::size_t invocations) const; // runs the bound compute pipeline, then a barrier

  private:
    Pipelines(Context& context) : context_(context) {}
    VkShaderModule module(const std::string& shader, const Specialization& constants);
    std::string key_of(const std::string& name, const Specialization& constants) const;
    void make_native_layout(std::uint32_t more_samplers);

    Context& context_;
    std::string folder_;
    const ForwardShaders* shaders_ = nullptr;
    std::vector<KnownNumber> numbers_;
    std::string numbers_key_;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE, native_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkSampler sampler_ = VK_NULL_HANDLE;
    // By everything that may distinguish them; several entries may hold the same
    std::map<std::string, VkShaderModule> modules_;
    std::map<std::string, VkPipeline> pipelines_;
    // By hash of the pruned words; by modules, state and constants
    std::map<std::uint64_t, VkShaderModule> modules_of_code_;
    std::map<std::string, VkPipeline> pipelines_of_code_;
};

} // namespace burnish
