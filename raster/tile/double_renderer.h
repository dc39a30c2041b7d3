// The tile renderer with a double by lane, for what asks how much floats lose.
#pragma once
#include <memory>

#include "raster/frame/frame.h"

namespace burnish {

// The same text, slowly. What one step hands to the next (the frame's record, vertices once they are transformed, texels, colours of
// fragments) is in words of floats still. Null where the program has no such lanes.
std::unique_ptr<Renderer> make_double_tile_renderer(const RenderInput& input);

} // namespace burnish
