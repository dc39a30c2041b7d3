// Lights for the lean shaders: the buffer LeanLights and the texture of transformed cosines (shading/lab/lean/lights.glsl).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "raster/vulkan/gpu_scene.h"

namespace burnish {

// Returns the lights that the frame has and the lean shaders do not draw; null: none.
const char* lights_that_lean_lacks(const GpuScene& scene);
// Returns the buffer LeanLights.
std::vector<glm::vec4> lean_lights(const GpuScene& scene);
// Uploads the table of transformed cosines: RGBA halves, lambda x root of alpha x planes of theta and phi.
DeviceImage upload_cosines(Context& context, const RenderInput& input);
// Uploads one level of halves and makes it readable. shape: format and size.
DeviceImage upload_halves(Context& context, const std::vector<std::uint16_t>& halves, ImageShape shape);

} // namespace burnish
