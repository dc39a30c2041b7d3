// Scenes and environments generated in code: nothing to download, the same bits everywhere.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

struct BuiltinInfo {
    const char* name; // without "builtin:"
    const char* summary;
};
const std::vector<BuiltinInfo>& builtin_scenes();       // teapot, spheres, sphere, plate, lights, glass, bumps, lacquer, shaderballs
const std::vector<BuiltinInfo>& builtin_environments(); // studio, sky, night

// Scenes that something breaks on, by one number: their names with =AMOUNT behind, or without for a usual one.
const std::vector<BuiltinInfo>& builtin_trials();

Result<Scene> make_builtin_scene(const std::string& name); // of either

// Equirectangular f32 RGB radiance, orientation as in shading/bake/environment/environment.h.
Result<Image> make_builtin_environment(const std::string& name);

} // namespace burnish
