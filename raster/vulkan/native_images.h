// Cubes and textures as device images, for native samplers: the texels of the flat pages without borders.
#pragma once
#include <map>
#include <vector>

#include "raster/vulkan/context.h"
#include "raster/vulkan/gpu_scene.h"

namespace burnish {

class NativeImages {
  public:
    NativeImages(Context& context, VkDescriptorSetLayout layout, const RenderInput& input, const GpuScene& scene);
    ~NativeImages();
    NativeImages(const NativeImages&) = delete;
    NativeImages& operator=(const NativeImages&) = delete;

    bool has_box() const { return has_box_; }
    VkDescriptorSet set(std::size_t material) const { return sets_[material]; } // for set 1

  private:
    explicit NativeImages(Context& context) : context_(context) {}
    DeviceImage upload(const std::uint16_t* texels, const std::vector<std::uint32_t>& offsets, int width, int height, int layers);
    VkSampler sampler(int wrap_s, int wrap_t, bool nearest);
    void make_sets(VkDescriptorSetLayout layout, const GpuScene& scene);

    Context& context_;
    bool has_box_ = false;
    std::vector<DeviceImage> cubes_, textures_;
    std::map<int, VkSampler> samplers_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> sets_; // by material
};

} // namespace burnish
