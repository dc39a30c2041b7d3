// Replaces the Vulkan renderer in a build without Vulkan.
#include "raster/vulkan/stage_files.h"
#include "raster/vulkan/vulkan_renderer.h"

namespace burnish {

bool vulkan_built()
{
    return false;
}

std::vector<VulkanDeviceInfo> vulkan_devices()
{
    return {};
}

namespace {
Error not_built()
{
    return {ExitCode::unavailable, "", "", "this program was built without Vulkan, which needs libvulkan and glslc"};
}
} // namespace

Status write_stages(const std::string&)
{
    return not_built();
}

Result<std::string> shade_stage_source()
{
    return not_built();
}

Result<std::shared_ptr<VulkanDevice>> open_vulkan_device(const VulkanOptions&)
{
    return not_built();
}

Result<std::unique_ptr<Renderer>> make_vulkan_renderer(const RenderInput&, const std::shared_ptr<VulkanDevice>&)
{
    return not_built();
}

} // namespace burnish
