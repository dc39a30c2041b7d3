// A scene that is ready to be drawn many times, and how it is looked at.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "apps/options/options.h"
#include "raster/session/session.h"

namespace burnish {

struct SeenScene {
    std::shared_ptr<const SceneData> data;
    View view;
};

// Of `base` the limits, the camera and the picture's size are read.
Result<SeenScene> load_seen_scene(const std::string& name, const RenderOptions& base, Report& report);

// Warns where some of the techniques draw opaque what lets light through.
void warn_of_opaque_glass(const Scene& scene, const std::vector<std::string>& techniques, Report& report);

} // namespace burnish
