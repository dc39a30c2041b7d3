// The Vulkan 1.3 renderer: the tile renderer's scene tables, frame description and kernels, on any device that the loader finds,
// without a window. There are two pipelines:
//   ids      the rasterizer writes triangle ids and depths by sample; a compute stage shades each distinct (pixel, triangle) pair once
//   forward  the classical pipeline: shades fragments during rasterization, multisampled, resolved by the device
// The exact sampler filters textures from buffers with the CPU's kernel. The native sampler lets the device filter.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "raster/frame/frame.h"

namespace burnish {

enum class VulkanSampler { exact, native };
enum class VulkanPipeline { ids, forward };
struct ForwardShaders; // raster/vulkan/forward_shaders.h

struct VulkanOptions {
    std::string device;      // "lavapipe", "swiftshader", "gpu", or a part of a device's name; empty: see prefer_cpu
    bool prefer_cpu = false; // without a name: takes the first CPU device (lavapipe before others), otherwise the first GPU, if any
    VulkanSampler sampler = VulkanSampler::exact;
    VulkanPipeline pipeline = VulkanPipeline::ids;
    bool centroid = false; // forward: the device chooses the shading point in partly covered pixels, which is cheaper; without stages
    const ForwardShaders* shaders = nullptr; // forward: drawn with these in place of the program's, with native samplers, without stages
    bool validate = false;                   // uses the Khronos validation layer; its messages make rendering fail
    std::string shader_folder;               // folder of NAME.spv that replace built-in shaders, for tests; empty: none
    bool use_cache = true;                   // stores pipelines on disk
    std::vector<FrameDesc> frames;           // all pipelines include these frames' techniques and lobes, so that the frames share pipelines
    std::size_t band_bytes = 0;              // size of a band's buffers, for tests; 0: the size that every device accepts
};

struct VulkanDeviceInfo {     // the driver's names
    std::string name, driver; // "llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    std::string api;          // "1.3.230"
    bool cpu = false;
};

bool vulkan_built(); // false: built without Vulkan; the functions below give ExitCode::unavailable
// Returns the GLSL of the stage that shades, without includes, for compilers to SPIR-V of Vulkan 1.3. Error: ExitCode::unavailable in a
// build without Vulkan.
Result<std::string> shade_stage_source();

// Lists all usable devices; empty if there is no driver. Also looks for SwiftShader at the place of Debian's chromium.
std::vector<VulkanDeviceInfo> vulkan_devices();

// A device with its pipelines, which all its renderers share. One thread at a time may use it.
class VulkanDevice {
  public:
    virtual ~VulkanDevice() = default;
    virtual const VulkanDeviceInfo& info() const = 0;
};

// Opens a device. Errors: ExitCode::unavailable if there is no such device.
Result<std::shared_ptr<VulkanDevice>> open_vulkan_device(const VulkanOptions& options);
Result<std::unique_ptr<Renderer>> make_vulkan_renderer(const RenderInput& input, const std::shared_ptr<VulkanDevice>& device);

} // namespace burnish
