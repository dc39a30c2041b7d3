// The lean shaders (shading/lab/lean), which draw as an engine would: material constants folded once per frame, albedo tables as images,
// vertices from buffers. Their pictures differ in bits from the tile renderer's. Frames that need a missing feature end with
// ExitCode::unavailable.
#pragma once
#include "raster/vulkan/vulkan_renderer.h"

namespace burnish {

// For VulkanOptions::shaders. Null in a build without Vulkan.
const ForwardShaders* lean_shaders();

} // namespace burnish
