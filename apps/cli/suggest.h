// What people probably meant.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// The one of `names` that `word` is a slip of the keyboard away from; empty where none is near.
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names); // "; did you mean 'NAME'?" or ""

bool looks_like_scene(const std::string& word); // a .gltf, a .glb, builtin:NAME

// "the built-in scene is called builtin:NAME" or "".
std::string builtin_scene_hint(const std::string& word);

// An error of opening what was given as a scene or as an environment, with what helps where the name tells.
Error with_scene_hint(Error error, const std::string& scene);
Error with_environment_hint(Error error, const std::string& environment);

} // namespace burnish
