// Triangles by tile, without locks: clusters are cut into chunks, each chunk fills its own lists, and a tile reads the chunks in
// order, so it sees triangles in draw order whatever the threads did.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/column.h"
#include "raster/tile/cull.h"
#include "raster/tile/tile_types.h"

namespace burnish {

// A tile, or a part of one that holds so many triangles that threads share it; a part is drawn as a smaller tile.
struct TilePart {
    static constexpr int kCuts = 2, kSide = 1 << kCuts; // a side is halved so often; parts along a side
    std::uint32_t tile;
    std::int32_t cut = -1; // which of the tiles that are cut, in the order they were given; -1: a whole tile
    std::int32_t part = 0; // of its parts, row by row
};

class Bins {
  public:
    void build(const FrameParams& frame, const DrawTables& tables, const Visible& visible, const TileFns& fns, const Jobs& jobs,
               Profiler* profiler);
    // Of every tile: the triangles that may show in it.
    std::vector<std::uint32_t> triangles_by_tile(std::size_t tiles) const;
    // Sorts the triangles of some tiles by part. `parts`: the frame as if its tiles were the parts.
    void cut(const FrameParams& parts, const std::vector<std::uint32_t>& tiles, const TileFns& fns, const Jobs& jobs);
    std::size_t triangles_in(const TilePart& part) const;
    // Copies its entries, in draw order, and what is known of its pieces; there is room for triangles_in() of each. Returns the number of
    // pieces, whose setups' vertex[0] are then indices into `clips`.
    std::size_t gather(const TilePart& part, std::uint32_t* entries, TriangleSetup* triangles, Column<ClipRecord>& clips) const;
    std::uint64_t triangle_count() const;

  private:
    struct Chunk {
        Column<std::uint32_t> entries; // see ChunkOutput
        Column<TileRun> runs;
        Column<ClippedPiece> pieces;
        Column<std::uint32_t> tile_begin;            // by tile, into `list`; one more at the end
        Column<std::uint32_t> list;                  // entries by tile, in draw order
        Column<std::uint32_t> part_begin, part_list; // the same by part of the tiles that are cut
        Column<std::uint32_t> first_part, last_part; // of the entries of a tile that is being cut: see TileRun
        ChunkOutput output = {};
        void make_room();
        void sort_by_tile(const FrameParams& frame);
        void sort_by_part(const FrameParams& parts, const std::vector<std::uint32_t>& tiles, const TileFns& fns);
        std::span<const std::uint32_t> entries_of(const TilePart& part) const;
    };
    std::vector<std::unique_ptr<Chunk>> chunks_; // kept from frame to frame for their memory
    std::size_t used_ = 0;
};

} // namespace burnish
