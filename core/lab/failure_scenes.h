// Failure scenes break a method as one number grows. `burnish atlas` runs them. They are small, lie at the origin and are viewed from +Z.
#pragma once
#include <vector>

#include "core/scene/builtin/builtin.h"

namespace burnish {

// Returns the scenes for add_parametric_scenes(). apps/cli/lab_scenes.def lists their names.
const std::vector<ParametricScene>& failure_scenes();

} // namespace burnish
