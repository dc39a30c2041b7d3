// Declares the tile renderer with kernels that make mistakes. They are compiled from the same source text, and slow.
#pragma once
#include <memory>

#include "raster/frame/frame.h"

namespace burnish {

// Makes a renderer whose kernels have the mistakes in drawn_mutants (shading/lab/conform/mutated.h). It draws by the techniques that
// mutated.h compiles alone. Null if the program lacks such lanes.
std::unique_ptr<Renderer> make_mutated_tile_renderer(const RenderInput& input);

} // namespace burnish
