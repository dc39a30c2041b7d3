// A scene in buffers of a device: what stays the same from frame to frame, and the records of one frame.
#pragma once
#include <vector>

#include "raster/frame/frame.h"
#include "raster/frame/upload.h"
#include "raster/vulkan/context.h"
#include "shading/lang/gpu_records.h"

namespace burnish {

// Pages of texels; textures follow.
inline constexpr int kSpecularPage = 0, kIrradiancePage = 1, kBoxPage = 2, kDfgPage = 3, kLobeAlbedoPage = 4, kFirstTexturePage = 5;
inline constexpr std::size_t kMaxGrid = 65536; // samples of filtered importance sampling

// Half the side of the rasterizer's viewport; see kGpuViewportHalf.
int viewport_half(const Features& features);

class GpuScene {
  public:
    GpuScene(Context& context, const RenderInput& input); // throws VulkanError where the device cannot hold it

    // The records of a frame, uploaded. Grid and box chain are made where the technique asks for them.
    void prepare(Context& context, const FrameDesc& desc, const SamplePattern& pattern, std::uint32_t setup_capacity);

    const Buffer& pages() const { return pages_; }
    const Buffer& reals() const { return reals_; }
    const Buffer& ints() const { return ints_; }
    const Buffer& frame() const { return frame_; }
    const Buffer& materials() const { return materials_; }
    const Buffer& textures() const { return textures_; }
    const Buffer& lights() const { return lights_; }
    const GpuFrame& record() const { return record_; }
    const SceneTables& tables() const { return scene_; }
    const std::vector<GpuMaterial>& material_records() const { return material_records_; }
    const CubeMap& box_cube() const { return box_; }

  private:
    void upload_pages(Context& context);
    void upload_tables(Context& context);
    void describe_frame(const FrameDesc& desc, const SamplePattern& pattern, std::uint32_t setup_capacity);

    RenderInput input_;
    SceneTables scene_;
    CubeMap box_; // made when a technique first asks for it
    std::vector<Buffer> texels_;
    std::vector<GpuMaterial> material_records_;
    Buffer pages_, reals_, ints_, frame_, materials_, textures_, lights_;
    GpuFrame record_ = {};
};

} // namespace burnish
