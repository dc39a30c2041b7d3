// Triangle lists per tile, without locks. Clusters are split into chunks, and each chunk fills its lists. A tile reads the chunks in
// order, so it sees triangles in draw order for any thread schedule.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/column.h"
#include "raster/tile/cull.h"
#include "raster/tile/tile_types.h"

namespace burnish {

// A tile, or a part of a tile with so many triangles that several threads share it. A part is drawn as a smaller tile.
struct TilePart {
    static constexpr int kCuts = 2, kSide = 1 << kCuts; // halvings of a side; parts along a side
    std::uint32_t tile;
    std::int32_t cut = -1; // index among the cut tiles, in the given order; -1: a whole tile
    std::int32_t part = 0; // index among its parts, row by row
};

class Bins {
  public:
    // Fills the lists from the visible clusters.
    void build(const FrameParams& frame, const DrawTables& tables, const Visible& visible, const TileFns& fns, const Jobs& jobs,
               Profiler* profiler);
    // Returns each tile's number of triangles that may show in it.
    std::vector<std::uint32_t> triangles_by_tile(std::size_t tiles) const;
    // Sorts the triangles of some tiles by part. parts: the frame with one tile's parts as its tiles.
    void cut(const FrameParams& frame, const FrameParams& parts, const std::vector<std::uint32_t>& tiles, const TileFns& fns,
             const Jobs& jobs);
    std::size_t triangles_in(const TilePart& part) const;
    // Copies a part's entries, in draw order, and its pieces' data. The outputs must have room for triangles_in() entries. Returns the
    // number of pieces. In a piece's setup, vertex[0] is an index into `clips`.
    std::size_t gather(const TilePart& part, std::uint32_t* entries, TriangleSetup* triangles, Column<ClipRecord>& clips) const;
    std::uint64_t triangle_count() const;

  private:
    struct Chunk {
        Column<std::uint32_t> entries; // see ChunkOutput
        Column<TileRun> runs;
        Column<ClippedPiece> pieces;
        Column<std::uint32_t> tile_begin;            // by tile, into `list`; one more at the end
        Column<std::uint32_t> list;                  // entries by tile, in draw order
        Column<std::uint32_t> part_begin, part_list; // the same by part of the cut tiles
        Column<std::uint32_t> first_part, last_part; // for entries of a tile that is being cut: see TileRun
        ChunkOutput output = {};
        void make_room();
        void sort_by_tile(const FrameParams& frame);
        void sort_by_part(const FrameParams& frame, const FrameParams& parts, const std::vector<std::uint32_t>& tiles, const TileFns& fns);
        std::span<const std::uint32_t> entries_of(const TilePart& part) const;
    };
    std::vector<std::unique_ptr<Chunk>> chunks_; // kept between frames to reuse their memory
    std::size_t used_ = 0;
};

} // namespace burnish
