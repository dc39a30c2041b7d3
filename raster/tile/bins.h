// Triangles by tile, without locks: clusters are cut into chunks, each chunk fills its own lists, and a tile reads the chunks in
// order, so it sees triangles in draw order whatever the threads did.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/column.h"
#include "raster/tile/cull.h"
#include "raster/tile/tile_types.h"

namespace burnish {

class Bins {
  public:
    void build(const FrameParams& frame, const DrawTables& tables, const Visible& visible, const TileFns& fns,
               const Jobs& jobs, Profiler* profiler);
    std::size_t triangles_in(std::size_t tile) const;
    // Copies the tile's triangles, in draw order; there is room for triangles_in(tile) of them.
    void gather_tile(std::size_t tile, TriangleSetup* triangles, TriangleSource* sources) const;
    std::uint64_t triangle_count() const;

  private:
    struct Chunk {
        Column<TriangleSetup> setups;
        Column<TileRect> rects;
        Column<std::uint32_t> triangles;
        Column<ClipRecord> clips;
        Column<std::uint32_t> tile_begin; // by tile, into `list`; one more at the end
        Column<std::uint32_t> list;       // into `setups`, by tile, ascending
        ChunkOutput output = {};
        void make_room();
        void sort_by_tile(const FrameParams& frame);
    };
    std::vector<std::unique_ptr<Chunk>> chunks_; // kept from frame to frame for their memory
    std::size_t used_ = 0;
};

} // namespace burnish
