// Culls draws and clusters. Culling is conservative and never changes a picture.
#pragma once
#include <cstdint>
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "raster/tile/profiler.h"
#include "raster/tile/tile_types.h"

namespace burnish {

struct Visible {
    std::vector<std::uint32_t> draws;    // ids, ascending
    std::vector<std::uint32_t> clusters; // ids, ascending
};

// Tests draw bounds and cluster spheres against the frustum, and cluster cones for back faces.
Visible cull(const DrawTables& tables, const std::vector<MaterialRecord>& materials, const View& view);

// Runs the vertex kernel over the visible draws' vertices.
void transform_draws(const FrameParams& frame, const DrawTables& tables, const Visible& visible, const TileFns& fns, const Jobs& jobs,
                     Profiler* profiler);

} // namespace burnish
