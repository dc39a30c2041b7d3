// A scene ready for rendering, with its view.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "apps/cli/report.h"
#include "apps/options/options.h"
#include "raster/session/session.h"

namespace burnish {

struct SceneWithView {
    std::shared_ptr<const SceneData> data;
    View view;
};

// Loads a scene with the limits, camera and picture size of `base`. Its pictures are decoded on all threads of `jobs`.
Result<SceneWithView> load_scene_with_view(const std::string& name, const RenderOptions& base, Report& report, const Jobs& jobs);

// Warns of each transmissive material with a volume whose mesh is open, and of blended surfaces, which glass does not show.
void warn_of_glass(const SceneData& data, Report& report);

} // namespace burnish
