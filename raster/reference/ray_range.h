// How far away rays can be followed.
#pragma once
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "raster/frame/frame.h"

namespace burnish {

// Embree takes origins and directions below 1.84e18 (its FLT_LARGE), beyond which squares do not fit a float. An order of magnitude is
// left for what is added to a coordinate on the way.
inline constexpr float kFarthestRay = 1e17f; // metres, along an axis

// Errors with ExitCode::bad_input that name the coordinate.
Status check_ray_range(const DrawTables& tables);
Status check_ray_range(const View& view);

} // namespace burnish
