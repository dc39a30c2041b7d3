// A scene that is ready to be drawn many times, and how it is looked at.
#pragma once
#include <memory>
#include <string>

#include "apps/render_options.h"
#include "apps/report.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"
#include "raster/frame/frame.h"

namespace burnish {

inline constexpr int kDfgSize = 64;     // texels a side of the directional albedo
inline constexpr int kDfgSamples = 256; // a texel

struct LoadedScene {
    std::string name;
    Scene scene;
    DrawTables tables;
    View view;
};

// Of `base` the limits, the camera and the picture's size are read.
Result<std::unique_ptr<LoadedScene>> load_seen_scene(const std::string& name, const RenderOptions& base, Report& report);

} // namespace burnish
