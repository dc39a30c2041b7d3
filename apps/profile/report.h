// What `burnish profile` measured, as a table, JSON and a flame-style picture.
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
    FrameStats stats;                   // of the last one
    std::vector<std::string> materials; // names
    double plain_ms = 0.0;              // median wall time of frames that were not profiled, drawn in turn with those that were
    double profiled_ms = 0.0;           // and of those
    double write_ms = 0.0;              // pictures encoded and written, once
    std::uint64_t hash = 0;             // of the linear pixels
};

std::string profile_table(const RenderOptions& options, const ProfileFigures& figures);
std::string profile_json(const RenderOptions& options, const ProfileFigures& figures);
// Widths are shares of the threads' time, waiting included: the frame, its phases, their stages, and the materials that were shaded.
std::string profile_svg(const RenderOptions& options, const ProfileFigures& figures);

} // namespace burnish
