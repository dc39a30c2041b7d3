// Shaders that a caller brings, which draw forward frames in place of forward.frag.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "raster/vulkan/bands.h"
#include "raster/vulkan/gpu_scene.h"
#include "raster/vulkan/native_images.h"
#include "raster/vulkan/pipelines.h"
#include "raster/vulkan/shaders.h"

namespace burnish {

// Draws one renderer's frames with such shaders.
class ForwardDrawer {
  public:
    virtual ~ForwardDrawer() = default;
    virtual void prepare(const FrameDesc& desc) = 0; // after the scene's prepare(); throws VulkanError
    // Draws scene and background into bound targets.
    virtual void draw(VkCommandBuffer c, const NativeImages& native, VkSampleCountFlagBits samples, VkFormat color, const Band& band) = 0;
};

struct ForwardShaders {
    std::vector<EmbeddedShader> files;
    std::uint32_t samplers = 0; // that a stage binds beside the samplers of NativeImages
    std::unique_ptr<ForwardDrawer> (*make)(Context& context, Pipelines& pipelines, GpuScene& scene, const RenderInput& input) = nullptr;
};

} // namespace burnish
