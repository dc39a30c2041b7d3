// Writes the mip levels of materials as standard textures for other programs.
#pragma once
#include <string>

#include "apps/bake/mip.h"
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"
#include "raster/frame/pyramids.h"

namespace burnish {

struct WrittenTextures {
    std::vector<std::string> files;
    std::string figures; // lines: errors of the textures against their levels
};

// Makes the folder and writes, for each material, normals, metallic-roughness, base colours and, for anisotropic lobes, anisotropy
// (standard_textures.h). Leaves no file behind on failure.
Result<WrittenTextures> write_mip_textures(const std::string& folder, const Scene& scene, const MaterialLevels& levels,
                                           const MipArguments& options, const Jobs& jobs);

} // namespace burnish
