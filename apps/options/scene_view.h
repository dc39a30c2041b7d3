// Which camera a frame is seen through.
#pragma once
#include <string>

#include "apps/options/options.h"
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"
#include "raster/frame/frame.h"

namespace burnish {

inline constexpr float kRadiansPerDegree = 0.017453292519943295f, kUsualFovDeg = 45.0f;
inline const glm::vec2 kUsualOrbitDeg(35.0f, 28.0f); // three quarters: a cube shows three faces

struct ChosenView {
    View view;
    std::string description; // for the log: "camera 0 'front'", "framed automatically"
    bool framed = false;     // automatically
};

// --eye, else --camera, else the scene's first camera that a node places, else (and with --orbit) a view of the whole scene.
Result<ChosenView> choose_view(const RenderOptions& options, const Scene& scene, const DrawTables& tables);

// "--eye X,Y,Z --target X,Y,Z --fov DEG", which gives the same view but for rounding, and for a camera's roll.
std::string camera_options(const View& view, const Scene& scene, const DrawTables& tables);

// "X,Y,Z" in world space of a place that is drawn, metres.
std::string world_place(const glm::vec3& place, const Scene& scene, int digits);

// The world-to-clip matrix in one line, rows in brackets.
std::string describe_matrix(const View& view, const Scene& scene);

} // namespace burnish
