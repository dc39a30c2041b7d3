// Area lights in texts, in world space: "quad:points=X,Y,Z/X,Y,Z/...:radiance=R,G,B:two-sided:solid". core/scene/area_light.def has shapes.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

// Returns words that point to a likely name, or an empty text.
using NameHint = std::function<std::string(const std::string& word, const std::vector<std::string>& names)>;

// Reads a light. Its texture file is not read yet (read_area_texture()). Errors: ExitCode::usage without a place.
Result<AreaLight> area_light_of(const std::string& text, const NameHint& hint = {});

} // namespace burnish
