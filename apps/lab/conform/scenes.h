// The scenes of a conformance folder: each is about one thing that engines get wrong.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/lab/conform/scene_file.h"
#include "core/image/image.h"
#include "core/scene/scene.h"

namespace burnish {

inline constexpr int kConformVersion = 2;                       // of the folder: scenes, environment and views
inline constexpr int kConformWidth = 256, kConformHeight = 192; // of its pictures
inline constexpr float kConformEv = -1.0f;                      // exposure at which pictures are compared, stops

struct ConformScene {
    std::string name, about;
    bool environment = true; // lit by the folder's environment; else black
    bool area_light = false; // lit by conform_area_light()
    std::function<SceneFile()> make;
};
const std::vector<ConformScene>& conform_scenes();
std::vector<std::string> scene_names();

// Returns the quad that lights a scene.
AreaLight conform_area_light();

// Returns the environment as an equirectangular picture, f32 RGB. No turn or mirror image of it equals it.
Image conform_environment();

} // namespace burnish
