// Front end for one instruction set; see geometry.isa.cpp.
#pragma once
#include "core/simd/lanes.h"
#include "raster/tile/tile_types.h"

namespace burnish {
inline namespace BN_ISA_NS {

void transform_vertices(const FrameParams& frame, std::uint32_t first, std::uint32_t count);
void bin_triangles(const FrameParams& frame, std::uint32_t first, std::uint32_t count, ChunkOutput& output);
void touch_tiles(const FrameParams& frame, int left, int top, const std::uint32_t* entries, std::uint32_t count, std::uint32_t* first_tile,
                 std::uint32_t* last_tile);

} // namespace BN_ISA_NS
} // namespace burnish
