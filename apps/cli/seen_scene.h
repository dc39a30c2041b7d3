// A scene that is ready to be drawn many times, and how it is looked at.
#pragma once
#include <memory>
#include <string>

#include "apps/cli/report.h"
#include "apps/render/options.h"
#include "raster/session/session.h"

namespace burnish {

struct SeenScene {
    std::shared_ptr<const SceneData> data;
    View view;
};

// Of `base` the limits, the camera and the picture's size are read.
Result<SeenScene> load_seen_scene(const std::string& name, const RenderOptions& base, Report& report);

} // namespace burnish
