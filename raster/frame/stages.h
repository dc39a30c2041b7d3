// The stages that a frame's time is divided into, in the order of the data.
#pragma once
#include <cstdint>

namespace burnish {

enum class FrameStage : std::int32_t { prepare, cull, transform, setup, bin, gather, clear, coverage, visibility, background, shade, resolve };
inline constexpr int kFrameStages = 12;
inline constexpr const char* kFrameStageNames[kFrameStages] = {
    "prepare",    // memory of the picture, constants of the frame
    "cull",       // draws and clusters that cannot be seen
    "transform",  // vertices
    "setup",      // triangles: clipping, snapping, edges
    "bin",        // triangles by tile
    "gather",     // a tile's triangles from the bins
    "clear",      // depth and ids of a tile
    "coverage",   // samples that a triangle covers, and depth
    "visibility", // samples to fragments, sorted by material
    "background", // shading where nothing is
    "shade",      // of fragments, by material
    "resolve",    // samples to pixels, written to the picture
};

} // namespace burnish
