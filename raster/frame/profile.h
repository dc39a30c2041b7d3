// Measurements of one frame, taken if FrameDesc::profile is set. Times are sums over threads.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "raster/frame/stages.h"

namespace burnish {

struct LaneUse { // lane use of a kernel that works on kLanes items at once
    std::uint64_t used = 0, all = 0;
};

struct KernelProfile { // shading of one material
    std::uint64_t ns = 0;
    LaneUse lanes; // used: shaded fragments
};

struct FrameProfile {
    std::uint64_t wall_ns = 0;
    std::array<std::uint64_t, kFrameStages> stage_ns = {};
    std::array<LaneUse, kFrameStages> stage_lanes = {}; // for transform, setup and background
    std::vector<KernelProfile> materials;               // by scene material
    std::vector<std::uint64_t> busy_ns;                 // by thread; the rest of wall_ns is waiting. Empty: not measured
    std::vector<std::uint64_t> tile_ns;                 // by tile, row by row
};

} // namespace burnish
