// Scenes and environments generated in code: nothing to download, equal bits everywhere.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/scene.h"

namespace burnish {

class Jobs;

struct BuiltinInfo {
    const char* name; // without "builtin:"
    const char* summary;
    bool staged = true; // scenes: is shown on a floor before a backdrop, having none of its own
};
const std::vector<BuiltinInfo>&
builtin_scenes(); // teapot, spheres, sphere, plate, lights, glass, bumps, lacquer, cloth, anodised, shaderballs
const std::vector<BuiltinInfo>& builtin_environments(); // studio, sky, night

// A scene whose name takes =AMOUNT; without it, the default amount applies.
struct ParametricScene {
    BuiltinInfo info;
    double by_default, least, most; // default and range of the amount
    Scene (*make)(double amount);
};
// Adds scenes to those that make_builtin_scene() makes; a program without laboratory has none. Call before other threads start.
void add_parametric_scenes(const std::vector<ParametricScene>& scenes);
const std::vector<ParametricScene>& parametric_scenes();

// Returns true for a built-in scene that is shown on the stage. name: without "builtin:".
bool builtin_is_staged(const std::string& name);

Result<Scene> make_builtin_scene(const std::string& name); // built-in and parametric scenes

// Makes equirectangular f32 RGB radiance, oriented as in shading/bake/environment/environment.h. jobs: may be null; never changes bits.
Result<Image> make_builtin_environment(const std::string& name, const Jobs* jobs = nullptr);

} // namespace burnish
