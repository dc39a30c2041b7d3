// Of programs that are built without Vulkan.
#include "raster/vulkan/vulkan_renderer.h"

namespace burnish {

bool vulkan_built() { return false; }

std::vector<VulkanDeviceInfo> vulkan_devices() { return {}; }

Result<std::unique_ptr<Renderer>> make_vulkan_renderer(const RenderInput&, const VulkanOptions&)
{
    return Error{ExitCode::unavailable, "", "--backend", "this program was built without the backend 'vulkan', which needs libvulkan and glslc"};
}

} // namespace burnish
