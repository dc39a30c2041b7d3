// Stages of a frame, in data order, for its profile.
#pragma once
#include <cstdint>

namespace burnish {

enum class FrameStage : std::int32_t {
    prepare,
    cull,
    transform,
    setup,
    bin,
    gather,
    clear,
    coverage,
    visibility,
    background,
    shade,
    resolve
};
inline constexpr int kFrameStages = 12;
inline constexpr const char* kFrameStageNames[kFrameStages] = {
    "prepare",    // memory for the picture, constants of the frame
    "cull",       // draws and clusters that cannot be visible
    "transform",  // vertices
    "setup",      // triangles: clipping, back faces, bounds in tiles
    "bin",        // lists of triangles per tile
    "gather",     // one tile's list of triangles
    "clear",      // a tile's depth and ids
    "coverage",   // triangle edges and depth planes, covered samples
    "visibility", // from samples to fragments, sorted by material
    "background", // shading of empty samples
    "shade",      // fragments, by material
    "resolve",    // from samples to pixels of the picture
};

} // namespace burnish
