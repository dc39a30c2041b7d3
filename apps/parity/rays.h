// Judges a device's visibility by rays and exact projections, which share no text with the clipping of triangles.
#pragma once
#include <cstdint>

#include "raster/session/session.h"

namespace burnish {

struct RayCounts {
    std::uint64_t samples = 0;      // compared; triangles with holes by alpha are left out
    std::uint64_t differ = 0;       // another triangle than the ray's
    std::uint64_t wrong = 0;        // of these: away from edges, and not equally deep
    int worst_x = -1, worst_y = -1; // a pixel with a wrong sample
};

// Makes the session that traces. No light is computed.
Result<Session> ray_session(const SessionParts& parts, Isa isa);

// Distances in pixels to an edge below which rounding may decide: our own pipeline snaps corners to 1/256 pixel, devices to 1/16 or finer.
inline constexpr double kOwnEdge = 1.0 / 64.0, kDeviceEdge = 1.0 / 8.0;

// Compares the triangle of each sample. A triangle other than the ray's is right where the sample is nearer than `edge` pixels to an edge
// of either triangle, where both are equally deep, and where the ray's triangle does not cover the sample by exact projection.
Result<RayCounts> compare_with_rays(const Frame& device, const FrameDesc& desc, Session& rays, double edge = kOwnEdge);

} // namespace burnish
