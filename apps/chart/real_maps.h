// Materials of pictures, to judge mipmaps by: folders with a normal map, and where they have them a roughness and a metallic map.
#pragma once
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "shading/bake/mipnet/families.h"

namespace burnish {

// Each folder of `folder`, by name: the middle of its normal map, 256 x 256 texels or the largest power of two that fits. Files are known
// by their names: "nor" or "normal"; "rough", or "orm" and "arm", whose green is roughness; "metal". A roughness that no file gives is .35.
Result<std::vector<mipnet::TestMaterial>> real_materials(const std::string& folder, const Limits& limits);

} // namespace burnish
