// Limits of ray coordinates.
#pragma once
#include "core/base/result.h"
#include "core/scene/draw_tables.h"
#include "raster/frame/frame.h"

namespace burnish {

// Embree accepts origins and directions below 1.84e18 (its FLT_LARGE); squares of larger numbers overflow a float. This limit leaves an
// order of magnitude for additions to a coordinate.
inline constexpr float kFarthestRay = 1e17f; // metres, along an axis

// Checks coordinates. Errors: ExitCode::bad_input, naming the coordinate.
Status check_ray_range(const DrawTables& tables);
Status check_ray_range(const View& view);

} // namespace burnish
