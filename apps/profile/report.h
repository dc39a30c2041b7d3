// The measurements of `burnish profile`, as a table, JSON and a flame graph.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/options/options.h"
#include "raster/frame/profile.h"

namespace burnish {

struct ProfileFigures {
    std::string device;
    int threads = 0, frames = 0;
    FrameProfile sum;                   // over the frames
    FrameStats stats;                   // the last frame
    std::vector<std::string> materials; // names
    double plain_ms = 0.0;              // median wall time of unprofiled frames, interleaved with profiled ones
    double profiled_ms = 0.0;           // median wall time of profiled frames
    double write_ms = 0.0;              // encoding and writing the pictures, once
    std::uint64_t hash = 0;             // linear pixels
};

std::string profile_table(const RenderOptions& options, const ProfileFigures& figures);
std::string profile_json(const RenderOptions& options, const ProfileFigures& figures);
// Draws a flame graph: the frame, its phases, their stages, and the shaded materials. Widths are shares of the threads' time with idle
// time.
std::string profile_svg(const RenderOptions& options, const ProfileFigures& figures);

} // namespace burnish
