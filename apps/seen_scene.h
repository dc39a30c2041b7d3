// A scene ready to be drawn, and the view of it.
#pragma once
#include <memory>
#include <string>

#include "apps/render_options.h"
#include "apps/report.h"
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "raster/frame/frame.h"

namespace burnish {

inline constexpr int kDfgSize = 64, kDfgSamples = 256; // of the albedo table: texels a side, samples a texel

struct LoadedScene {
    std::string name;
    Scene scene;
    DrawTables tables;
    View view;
};

// `name`: as SCENE of `burnish render`. Limits and camera are those of `base`; warnings go to the report.
Result<std::unique_ptr<LoadedScene>> load_seen_scene(const std::string& name, const RenderOptions& base, Report& report);

} // namespace burnish
