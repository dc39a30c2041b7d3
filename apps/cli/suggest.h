// Guesses the name that the user meant.
#pragma once
#include <string>
#include <vector>

#include "core/base/result.h"

namespace burnish {

// Returns the name within a few typing errors of `word`, or an empty string.
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names); // "; did you mean 'NAME'?" or ""

bool looks_like_scene(const std::string& word); // *.gltf, *.glb, builtin:NAME

// Returns "the built-in scene is called builtin:NAME" or "".
std::string builtin_scene_hint(const std::string& word);

// Adds a hint to the error of opening a scene or an environment, if the name suggests one.
Error with_scene_hint(Error error, const std::string& scene);
Error with_environment_hint(Error error, const std::string& environment);

} // namespace burnish
