// Replaces the lean shaders in a build without Vulkan.
#include "raster/vulkan/lab/lean.h"

namespace burnish {

const ForwardShaders* lean_shaders()
{
    return nullptr;
}

} // namespace burnish
