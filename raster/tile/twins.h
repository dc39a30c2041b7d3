// The tile renderer with other lanes, compiled from the same source text. Some are double, some count their work. All are slow.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "raster/frame/frame.h"
#include "raster/tile/tile_types.h"

namespace burnish {

// Makes a renderer with double lanes, to measure float errors. Data between steps (the frame's record, transformed vertices, texels,
// fragment colours) is still float. Null if the program lacks such lanes.
std::unique_ptr<Renderer> make_double_tile_renderer(const RenderInput& input);

// Makes a renderer with lanes that the caller's program links. fns: must outlive the renderer. lanes: their name, in Renderer::device().
std::unique_ptr<Renderer> make_tile_renderer_of(const RenderInput& input, const TileFns& fns, const std::string& lanes);

struct CountedFrame {
    Frame frame; // pixels equal any other lanes'
    LaneWork work;
};
bool has_counting_lanes();
// Draws a frame on the calling thread with lanes that count. The work is equal on every machine and for every number of threads; it depends
// on the description, its tile size included. Errors: Renderer::render()'s; ExitCode::unavailable without such lanes.
Result<CountedFrame> draw_counted(const RenderInput& input, const FrameDesc& desc);

} // namespace burnish
