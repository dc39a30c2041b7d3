// Textures that hold a mip filter's levels: normals, and moments of their slopes and lobes (pyramids.h).
#pragma once
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/pyramids.h"

namespace burnish {

// Returns the pyramid of each key. The keys are filtered, and name one material and texture. All are written in one pass over the maps'
// rows. kept, levels: those of the material.
std::vector<TexturePyramid> filtered_textures(const Scene& scene, const SceneMips& mips, const KeptWeights& kept,
                                              const std::vector<PyramidKey>& keys, const MipLevels& levels, const Jobs& jobs);

} // namespace burnish
