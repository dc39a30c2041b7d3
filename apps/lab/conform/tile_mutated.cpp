#include "apps/lab/conform/tile_mutated.h"

#include "raster/tile/twins.h"

namespace burnish {

std::unique_ptr<Renderer> make_mutated_tile_renderer(const RenderInput& input)
{
    const auto fns = FnsByIsa<TileFns>::mutated;
    return fns ? make_tile_renderer_of(input, fns(nullptr), "mutated") : nullptr;
}

} // namespace burnish
