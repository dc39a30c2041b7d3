// The tile renderer: SIMD, multithreaded, multisampled. Its pixels depend on version, scene and options alone.
#pragma once
#include <memory>

#include "raster/frame/frame.h"

namespace burnish {

std::unique_ptr<Renderer> make_tile_renderer(const RenderInput& input, Isa isa);

} // namespace burnish
