// The two halves of a tile: visibility (visible.isa.cpp) and colours (tile.isa.cpp).
#pragma once
#include "core/simd/lanes.h"
#include "raster/tile/tile_types.h"
#include "shading/kernels/vertex.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

struct Tile : TileRect {
    const FrameParams& f;
    TileScratch& s;
};

enum class Surfaces {
    solid, // opaque and masked surfaces; blended triangles are listed in PeelScratch::triangles
    all    // blended surfaces too, where alpha exceeds a half
};

// Draws the tile's triangles and lists its fragments by material, slot by slot (TileScratch::slot_begin and others). Returns the number of
// slots; slot 0 is the background.
int find_visible(const Tile& tile, const view_params& view, Surfaces surfaces);

// Starts the tile's blended layers. The solid surfaces must be known.
void begin_layers(const Tile& tile);
// Lists the next layer's fragments in PeelScratch::layer, as find_visible() does. Returns the number of slots: 1 if there is no further
// layer.
int find_layer(const Tile& tile);

// Reports the end of a stage. Costs one test if there is no profiler.
BN_INLINE void lap(const TileScratch& s, FrameStage stage, std::int32_t material = -1, std::uint32_t used = 0)
{
    if (s.clock)
        s.clock->lap(*s.clock, stage, material, used, (used + kLanes - 1) / kLanes * kLanes);
}

} // namespace BN_ISA_NS
} // namespace burnish
