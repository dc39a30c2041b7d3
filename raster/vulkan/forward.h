// The forward pipeline: shades fragments during rasterization, with multisampling, resolved by the device. A triangle that covers only
// some samples of a pixel is shaded at their mean, as in the tile renderer. Here hidden samples count too.
#pragma once
#include <memory>
#include <optional>

#include "raster/vulkan/bands.h"
#include "raster/vulkan/forward_shaders.h"
#include "raster/vulkan/gpu_scene.h"
#include "raster/vulkan/native_images.h"
#include "raster/vulkan/pipelines.h"

namespace burnish {

class ForwardPass {
  public:
    ForwardPass(Context& context, Pipelines& pipelines, GpuScene& scene, const RenderInput& input, const VulkanOptions& options)
        : context_(context), pipelines_(pipelines), scene_(scene), input_(input), sampler_(options.sampler), centroid_(options.centroid)
    {
        if (options.shaders)
            drawer_ = options.shaders->make(context, pipelines, scene, input);
    }
    // Makes images and pipelines; ExitCode::unavailable if the device lacks this sample count.
    void prepare(const FrameDesc& desc, std::size_t band_bytes);
    int rows() const { return targets_.rows; } // of a band
    void draw(VkCommandBuffer c, const Specialization& technique, const Band& band);
    void read(const Band& band, Frame& frame); // reads the resolved picture
    // Records the band's intermediate values, after draw and read, with FrameDesc::stages. Draws the scene once for every four words of a
    // fragment, with equal vertices and rules, and with triangle numbers.
    void record(const FrameDesc& desc, const Band& band, Frame& frame);

  private:
    struct Targets {
        int width = 0, rows = 0, msaa = 0; // 0: none
        bool stages = false;
        DeviceImage color, depth, resolved; // color: none with one sample
        Buffer pixels, ids, depths, words;  // the last three: for stages
    };
    void make_targets(const FrameDesc& desc, std::size_t band_bytes);
    const DeviceImage& samples() const { return targets_.msaa > 1 ? targets_.color : targets_.resolved; }
    void begin(VkCommandBuffer c, const Band& band, bool resolves);
    void draw_scene(VkCommandBuffer c, const Specialization& technique, const GpuPass& pass, bool stages);
    void draw_backdrop(VkCommandBuffer c, const GpuPass& pass);
    void gather(VkCommandBuffer c, const char* shader, const Band& band, int group);
    void fill_frame(const FrameDesc& desc, const Band& band, Frame& frame) const;
    GraphicsState state(std::string vertex, std::string fragment, VkCompareOp compare) const;
    void bind_native(VkCommandBuffer c, std::size_t material);

    Context& context_;
    Pipelines& pipelines_;
    GpuScene& scene_;
    RenderInput input_;
    VulkanSampler sampler_;
    bool centroid_;
    std::optional<NativeImages> native_;
    std::unique_ptr<ForwardDrawer> drawer_; // null: forward.frag draws
    Targets targets_;
};

} // namespace burnish
