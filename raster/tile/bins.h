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
    // Copies the tile's entries, in draw order, and what is known of its pieces; there is room for triangles_in(tile) of each. Returns the
    // number of pieces, whose setups' vertex[0] are then indices into `clips`.
    std::size_t gather_tile(std::size_t tile, std::uint32_t* entries, TriangleSetup* triangles, Column<ClipRecord>& clips) const;
    std::uint64_t triangle_count() const;

  private:
    struct Chunk {
        Column<std::uint32_t> entries, first_tile, last_tile; // see ChunkOutput
        Column<ClippedPiece> pieces;
        Column<std::uint32_t> tile_begin; // by tile, into `list`; one more at the end
        Column<std::uint32_t> list;       // entries by tile, in draw order
        ChunkOutput output = {};
        void make_room();
        void sort_by_tile(const FrameParams& frame);
    };
    std::vector<std::unique_ptr<Chunk>> chunks_; // kept from frame to frame for their memory
    std::size_t used_ = 0;
};

} // namespace burnish
