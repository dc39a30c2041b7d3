// A scene in device buffers: data that stays between frames, and one frame's records.
#pragma once
#include <vector>

#include "raster/frame/frame.h"
#include "raster/frame/frame_record.h"
#include "raster/vulkan/context.h"
#include "shading/lang/gpu_records.h"

namespace burnish {

// Returns half the side of the rasterizer's viewport; see kGpuViewportHalf.
int viewport_half(const Features& features);

class GpuScene {
  public:
    GpuScene(Context& context, const RenderInput& input); // throws VulkanError if the device cannot hold the scene

    // Uploads a frame's records, and tables that the frame is the first to need.
    void prepare(Context& context, const FrameDesc& desc, std::uint32_t setup_capacity);

    const Buffer& pages() const { return pages_; }
    const Buffer& reals() const { return reals_; }
    const Buffer& ints() const { return ints_; }
    const Buffer& frame() const { return frame_; }
    const Buffer& materials() const { return materials_; }
    const Buffer& textures() const { return textures_; }
    const Buffer& lights() const { return lights_; }
    const Buffer& area_lights() const { return area_lights_; }
    bool shows_behind(const FrameDesc& desc) const { return maker_.shows_behind(desc); }
    void take_behind(const Frame& frame) { maker_.take_behind(frame); }
    const FrameRecord& record() const { return record_.frame; }
    const GpuPlaces& places() const { return record_.places; }
    Status check(const FrameDesc& desc) const { return maker_.check(desc); }
    const SceneTables& tables() const { return maker_.scene(); }
    const std::vector<MaterialRecord>& materials_of_frame() const { return maker_.materials(); }
    const CubeMap& mip_env() const { return maker_.mip_env(); }
    const std::vector<GridSample>& grid() const { return maker_.grid(); }
    const Column<float>& lobe_slices() const { return maker_.lobe_slices(); }

  private:
    void upload_pages(Context& context);
    void upload_tables(Context& context);
    void upload_behind(Context& context);

    RenderInput input_;
    FrameMaker maker_;
    std::vector<Buffer> texels_;
    Buffer pages_, reals_, ints_, frame_, materials_, textures_, lights_, area_lights_;
    int behind_width_ = 0, behind_height_ = 0; // of the picture in texels_
    GpuFrame record_ = {};
};

} // namespace burnish
