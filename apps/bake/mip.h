// Levels of a scene's materials, to be kept and to be looked at.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "raster/frame/pyramids.h"
#include "shading/bake/mip/levels.h"

namespace burnish {

struct MipPicture {
    std::string name; // of a file, without its extension
    Image image;
};

// Of every level from 1 on two pictures: normals as a normal map has them, and lobes in false colour: red and green the widths' roots
// (perceptual roughness, 0 to 1) along tangent and bitangent, blue how the axis lies between them (128: along one).
std::vector<MipPicture> mip_pictures(const std::string& material, const MipLevels& levels);

// Those of each material as PNG in a folder, which is made.
Status write_mip_preview(const std::string& folder, const Scene& scene, const MaterialLevels& levels, Report& report);

} // namespace burnish
