// Draws a scene with the lean stages (shading/stages/lean), in place of forward.frag: material constants folded once per frame, albedo
// tables as images, vertices from buffers.
#pragma once
#include <map>
#include <vector>

#include "raster/vulkan/bands.h"
#include "raster/vulkan/gpu_scene.h"
#include "raster/vulkan/native_images.h"
#include "raster/vulkan/pipelines.h"

namespace burnish {

// Checks that the lean stages can draw the frame. Errors: ExitCode::unavailable, naming the missing feature. record, materials: of the
// frame.
Status check_lean(const FrameDesc& desc, const FrameRecord& record, const std::vector<MaterialRecord>& materials);

class LeanScene {
  public:
    LeanScene(Context& context, Pipelines& pipelines, GpuScene& scene, const RenderInput& input);
    ~LeanScene();
    LeanScene(const LeanScene&) = delete;
    LeanScene& operator=(const LeanScene&) = delete;

    void prepare(const FrameDesc& desc); // after the scene's prepare(); throws the error of check_lean()
    // Draws scene and sky into bound targets.
    void draw(VkCommandBuffer c, const NativeImages& native, VkSampleCountFlagBits samples, VkFormat color, const Band& band);

  private:
    DeviceImage upload_table(const float* pairs, int width, int height, int depth);
    const DeviceImage& slice(int first, int size); // size: texels along n.v
    void fill_materials(const FrameDesc& desc);
    void make_sets();

    Context& context_;
    Pipelines& pipelines_;
    GpuScene& scene_;
    RenderInput input_;
    Buffer positions_, shading_, frame_, materials_, grid_;
    DeviceImage round_albedo_, width_albedo_;
    std::map<int, DeviceImage> slices_;     // by MaterialRecord::albedo_slice
    std::vector<Specialization> constants_; // by material
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> sets_; // for set 0, by material
};

} // namespace burnish
