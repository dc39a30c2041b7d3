// Which draws and clusters can be seen at all. Conservative: culling never changes a picture.
#pragma once
#include <cstdint>
#include <vector>

#include "core/jobs/jobs.h"
#include "raster/frame/frame.h"
#include "raster/tile/profiler.h"
#include "raster/tile/tile_types.h"

namespace burnish {

struct Visible {
    std::vector<std::uint32_t> draws;    // by id, ascending
    std::vector<std::uint32_t> clusters; // by id, ascending
};

// Frustum by draw bounds and cluster spheres, back faces by cluster cones.
Visible cull(const DrawTables& tables, const View& view);

// Runs the vertex kernel over the visible draws' vertices.
void transform_draws(const FrameParams& frame, const DrawTables& tables, const Visible& visible, const TileFns& fns, const Jobs& jobs,
                     Profiler* profiler);

} // namespace burnish
