// The Vulkan renderer's stages as files.
#pragma once
#include <string>

#include "core/base/result.h"

namespace burnish {

// Writes the program's stages into a folder as NAME.spv, for VulkanOptions::shader_folder. Errors: ExitCode::unavailable without Vulkan,
// output_failed.
Status write_stages(const std::string& folder);

} // namespace burnish
