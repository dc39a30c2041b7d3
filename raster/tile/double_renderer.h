// The tile renderer with double lanes, for measurements of float errors.
#pragma once
#include <memory>

#include "raster/frame/frame.h"

namespace burnish {

// Makes a renderer from the same source text; it is slow. Data between steps (the frame's record, transformed vertices, texels, fragment
// colours) is still float. Null if the program lacks such lanes.
std::unique_ptr<Renderer> make_double_tile_renderer(const RenderInput& input);

} // namespace burnish
