// Writes the mip levels of materials as standard textures for other programs.
#pragma once
#include <string>

#include "apps/bake/mip.h"
#include "core/jobs/jobs.h"
#include "raster/frame/pyramids.h"
#include "raster/session/session.h"

namespace burnish {

struct WrittenTextures {
    std::vector<std::string> files;
    std::string figures; // lines: errors of the textures against their levels
};

// Into a folder, which is made: normals, metallic-roughness, anisotropy where a lobe has any, and base colours, as standard_textures.h has
// them, by material. On failure nothing of them is left.
Result<WrittenTextures> write_mip_textures(const std::string& folder, const SceneData& data, const MaterialLevels& levels,
                                           const MipArguments& options, const Jobs& jobs);

} // namespace burnish
