// A picture of directions on all materials, as if their file had named it under KHR_materials_anisotropy.
#pragma once
#include <string>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

// Every material that something with texture coordinates wears takes the picture (red and green: direction, blue: strength) as its
// anisotropy texture, in the first set of coordinates. One that had no strength of anisotropy gets 1, which blue scales. Errors: what is no
// picture of three channels, more bytes than textures may have, a scene without texture coordinates.
Status put_direction_map(Scene& scene, const std::string& path, const Limits& limits);

} // namespace burnish
