// The stages that a frame's time is divided into, in the order of the data.
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
    "prepare",    // memory of the picture, constants of the frame
    "cull",       // draws and clusters that cannot be seen
    "transform",  // vertices
    "setup",      // triangles: clipping, back faces, the tiles that they may touch
    "bin",        // triangles by tile
    "gather",     // the list of a tile's triangles
    "clear",      // depth and ids of a tile
    "coverage",   // edges and depth planes of triangles, the samples that they cover
    "visibility", // samples to fragments, sorted by material
    "background", // shading where nothing is
    "shade",      // of fragments, by material
    "resolve",    // samples to pixels, written to the picture
};

} // namespace burnish
