// Photographed materials for tests of mip filters: folders with a normal map and optional roughness and metallic maps.
#pragma once
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "shading/lab/mipnet/families.h"

namespace burnish {

// Returns one material for each folder in `folder` with a normal map, sorted by name. Each is the middle of the map, 256 x 256 texels or
// the largest power of two that fits, 32 at least. File names tell the maps apart: "norm" or "_nor_"; "rough", or "_orm" and "_arm" with
// roughness in green; "metal". Roughness is 0.35 without a file of the normal map's size.
Result<std::vector<mipnet::TestMaterial>> real_materials(const std::string& folder, const Limits& limits);

} // namespace burnish
