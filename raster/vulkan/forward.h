// The classical pipeline: fragments shaded as they are rasterized, multisampled, resolved by the device.
#pragma once
#include <optional>

#include "raster/vulkan/gpu_scene.h"
#include "raster/vulkan/native_images.h"
#include "raster/vulkan/pipelines.h"

namespace burnish {

class ForwardPass {
  public:
    ForwardPass(Context& context, Pipelines& pipelines, GpuScene& scene, const RenderInput& input, VulkanSampler sampler)
        : context_(context), pipelines_(pipelines), scene_(scene), input_(input), sampler_(sampler)
    {
    }
    // Makes images and pipelines ready; ExitCode::unavailable where the device does not take so many samples.
    void prepare(const FrameDesc& desc);
    void draw(VkCommandBuffer c, const FrameDesc& desc, const Specialization& technique);
    void read(VkCommandBuffer c); // the resolved picture to pixels()
    const float* pixels() const { return pixels_.as<float>(); } // RGBA

  private:
    void draw_scene(VkCommandBuffer c, const FrameDesc& desc, const Specialization& technique);
    void draw_backdrop(VkCommandBuffer c);
    GraphicsState state(const char* vertex, const char* fragment, VkCompareOp compare) const;
    void bind_native(VkCommandBuffer c, std::size_t material);

    Context& context_;
    Pipelines& pipelines_;
    GpuScene& scene_;
    RenderInput input_;
    VulkanSampler sampler_;
    std::optional<NativeImages> native_;
    int width_ = 0, height_ = 0, msaa_ = 0;
    DeviceImage color_, depth_, resolved_;
    Buffer pixels_;
};

} // namespace burnish
