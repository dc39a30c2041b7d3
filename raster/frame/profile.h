// What a renderer measured about one frame, where FrameDesc::profile asked for it. Times are summed over the threads.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "raster/frame/stages.h"

namespace burnish {

struct LaneUse { // of a kernel that works on kLanes things at once
    std::uint64_t used = 0, all = 0;
};

struct KernelProfile { // shading of one material
    std::uint64_t ns = 0;
    LaneUse lanes; // used: fragments shaded
};

struct FrameProfile {
    std::uint64_t wall_ns = 0;
    std::array<std::uint64_t, kFrameStages> stage_ns = {};
    std::array<LaneUse, kFrameStages> stage_lanes = {}; // of transform, setup and background
    std::vector<KernelProfile> materials;               // by material of the scene
    std::vector<std::uint64_t> busy_ns;                 // by thread; the rest of wall_ns it waited. Empty: nothing was measured
    std::vector<std::uint64_t> tile_ns;                 // by tile, row by row
};

} // namespace burnish
