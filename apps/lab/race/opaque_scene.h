// A scene without the surfaces that one opaque pass cannot draw.
#pragma once
#include <memory>
#include <string>

#include "raster/session/session.h"

namespace burnish {

struct OpaqueScene {
    std::shared_ptr<const SceneData> data; // the given scene where nothing is left out
    int left_out = 0, materials = 0;       // materials that are left out; those that the whole scene draws
    bool empty() const { return left_out > 0 && left_out == materials; }
};

// Leaves out primitives whose material lets light through or has AlphaMode::blend. Materials keep their indices, and the bounds stay the
// whole scene's. whole: without a floor.
Result<OpaqueScene> opaque_scene(const std::shared_ptr<const SceneData>& whole);

// Returns one line on the materials that are left out; empty where there are none.
std::string left_out_note(const OpaqueScene& scene);

} // namespace burnish
