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

// Loads a scene with the limits, camera and picture size of `base`.
Result<SceneWithView> load_scene_with_view(const std::string& name, const RenderOptions& base, Report& report);

// Warns if some techniques draw transmissive surfaces as opaque.
void warn_of_opaque_glass(const Scene& scene, const std::vector<std::string>& techniques, Report& report);

} // namespace burnish
