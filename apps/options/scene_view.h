// Chooses the camera of a frame.
#pragma once
#include <string>

#include "apps/options/options.h"
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"
#include "raster/frame/frame.h"

namespace burnish {

inline constexpr float kRadiansPerDegree = 0.017453292519943295f, kDefaultFovDeg = 45.0f;
inline const glm::vec2 kDefaultOrbitDeg(35.0f, 28.0f); // a three-quarter view: a cube shows three faces

struct ChosenView {
    View view;
    std::string description; // for the log: "camera 0 'front'", "framed automatically"
    bool framed = false;     // by burnish, not by a camera
};

// Takes --eye, else --camera, else the scene's first camera on a node, else a view of the whole scene. --orbit also frames the whole
// scene.
Result<ChosenView> choose_view(const RenderOptions& options, const Scene& scene, const DrawTables& tables);

// Returns "--eye X,Y,Z --target X,Y,Z --fov DEG" for the same view, up to rounding and camera roll.
std::string camera_options(const View& view, const Scene& scene, const DrawTables& tables);

// Returns the unit direction from the surface at pixel (x, y) of a picture to the eye.
glm::vec3 to_eye(const View& view, int width, int height, int x, int y);

// Formats a point of the draw tables as "X,Y,Z" in world space, metres.
std::string world_place(const glm::vec3& place, const Scene& scene, int digits);

// Formats the world-to-clip matrix in one line, rows in brackets.
std::string describe_matrix(const View& view, const Scene& scene);

} // namespace burnish
