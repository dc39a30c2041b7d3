// The renderer over Vulkan 1.3: the same scene tables, frame description and kernels as the tile renderer, on any device that the loader
// finds, without a window. Two pipelines:
//   ids      the rasterizer gives triangle ids and depths by sample; a compute stage shades each distinct (pixel, triangle) pair once
//   forward  the classical one: fragments are shaded as they are rasterized, multisampled, and resolved by the device
//   lean     forward by the shaders that an engine would write (shading/stages/lean), for races: not the tile renderer's bits, and
//            ExitCode::unavailable where a frame wants what they do not draw
// With the exact sampler textures are filtered by the same kernel as on the CPU, from buffers; with the native one by the device.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "raster/frame/frame.h"

namespace burnish {

enum class VulkanSampler { exact, native };
enum class VulkanPipeline { ids, forward, lean };

struct VulkanOptions {
    std::string device;      // "lavapipe", "swiftshader", "gpu", or a part of a device's name; empty: see prefer_cpu
    bool prefer_cpu = false; // without a name: the first CPU device (lavapipe before others), otherwise the first GPU, if any
    VulkanSampler sampler = VulkanSampler::exact;
    VulkanPipeline pipeline = VulkanPipeline::ids;
    bool centroid = false;         // forward: partly covered pixels are shaded where the device likes, which is cheaper; without stages
    bool validate = false;         // with the Khronos validation layer; what it says makes rendering fail
    std::string shader_folder;     // of NAME.spv in place of the program's own shaders, for tests; empty: none
    bool use_cache = true;         // pipelines on disk
    std::vector<FrameDesc> frames; // whose techniques and lobes pipelines hold beside their frame's own, so that all of them share one
    std::size_t band_bytes = 0;    // of the buffers of one band of rows, for tests; 0: as many as every device takes
};

struct VulkanDeviceInfo {     // what the driver calls itself
    std::string name, driver; // "llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    std::string api;          // "1.3.230"
    bool cpu = false;
};

bool vulkan_built(); // false: built without Vulkan, and everything below says ExitCode::unavailable
// All devices that can be used; empty where there is no driver. SwiftShader is looked for where Debian's chromium keeps it.
std::vector<VulkanDeviceInfo> vulkan_devices();

// A device with its pipelines, which are made once for all renderers on it. Not to be used by two threads at once.
class VulkanDevice {
  public:
    virtual ~VulkanDevice() = default;
    virtual const VulkanDeviceInfo& info() const = 0;
};

// ExitCode::unavailable where there is no such device.
Result<std::shared_ptr<VulkanDevice>> open_vulkan_device(const VulkanOptions& options);
Result<std::unique_ptr<Renderer>> make_vulkan_renderer(const RenderInput& input, const std::shared_ptr<VulkanDevice>& device);

} // namespace burnish
