// The tile renderer's tables: plain data, shared by baseline code and instruction-set objects. Sub-pixel units: 1/256 pixel, x right, y
// down, relative to the image's integer centre pixel, so that |x|, |y| < 2^22.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"
#include "raster/frame/stages.h"
#include "shading/lang/tables.h"

namespace burnish {

inline constexpr int kBlock = 8; // coverage and hierarchical depth work on 8x8 pixels
inline constexpr int kBlockPixels = kBlock * kBlock;
inline constexpr int kMaxTileSize = 64; // pixels along a side

// Shared-sample tables by pixel: a tile's rows with a margin around them.
inline constexpr int kSharedMargin = 8, kSharedStride = kMaxTileSize + 2 * kSharedMargin;
inline constexpr int kSharedPixels = (kMaxTileSize + 3) * kSharedStride; // one row before and one after, and a row with spare lanes
inline constexpr int kSharedWords = 13, kSharedPlanes = 11;              // see share.h

// A transformed vertex.
struct alignas(16) SnappedVertex {
    std::int32_t x, y; // sub-pixel units; x = kNeedsClip if the vertex has no snapped position
    float inv_w;       // 1 / clip w
    float z;           // depth, reversed: 1 near, 0 far
};

// A triangle ready for rasterization, one cache line. Vertices are ordered so that the area is positive with y down.
struct alignas(64) TriangleSetup {
    std::int32_t x[3], y[3]; // as in SnappedVertex
    float inv_w[3];
    float z[3];
    std::int32_t vertex[3]; // into DrawTables::shading
    std::int32_t info;      // material << 2 | kFrontFacing | kClipped; a clipped piece's vertex[0] is an index into TileScratch::clips
};
static_assert(sizeof(TriangleSetup) == 64);

// Piece from a triangle that crossed the near plane or left the guard band. Corners are barycentrics in the whole triangle.
struct alignas(64) ClipRecord {
    float bary[9];          // the piece's corner j = sum_k bary[3j+k] * vertex k
    std::int32_t vertex[3]; // the whole triangle's
    std::uint32_t triangle; // its global id
    float pad[3];
};
static_assert(sizeof(ClipRecord) == 64);

struct ClippedPiece {
    TriangleSetup setup; // without vertices
    ClipRecord record;
};

// A triangle list's entry is a whole triangle's global id, below 2^31 / 3 (make_draw_tables ensures this), or kClippedEntry and a
// piece's index.
inline constexpr std::uint32_t kClippedEntry = 1u << 31;

// Consecutive entries that may touch the same tiles.
struct TileRun {
    std::uint32_t first_tile, last_tile; // x | y << 16: their rectangle's corners
    std::uint32_t count;
};

struct ChunkOutput { // a cluster chunk's output, in draw order
    std::uint32_t* entries;
    TileRun* runs; // cover all entries
    std::uint32_t count, run_count, capacity;
    ClippedPiece* pieces;
    std::uint32_t piece_count, piece_capacity;
    void (*grow)(ChunkOutput* self); // makes room for at least kGrowRoom more entries and pieces
    void* owner;
};
inline constexpr std::uint32_t kGrowRoom = 256;

// Appends a run: the tiles that the next n entries may touch.
inline void add_run(ChunkOutput& out, std::uint32_t first_tile, std::uint32_t last_tile, std::uint32_t n)
{
    TileRun* const run = out.runs + out.run_count;
    if (out.run_count > 0 && run[-1].first_tile == first_tile && run[-1].last_tile == last_tile)
        run[-1].count += n;
    else
        *run = {first_tile, last_tile, n}, ++out.run_count;
}

// All frame data that a tile needs; constant while the frame is drawn.
struct FrameParams : ShadingFrame {
    std::int32_t tile_size; // pixels along the side in a tile's memory, a power of two
    std::int32_t tile_step; // pixels from a tile's own pixels to the next tile's
    std::int32_t tile_rim;  // pixels around its own that a tile shades too, for neighbours that share samples
    std::int32_t tiles_x, tiles_y;
    SnappedVertex* vertices; // by global vertex id
    bool blends;             // some material blends
    bool defers_bodies;      // leaves tiles that show transmissive materials undrawn
};

// A tile's pixels. Every image pixel is one tile's own.
struct TileRect {
    int x0, y0;                         // its memory's corner in the image: multiples of kBlock, so that depths do not depend on tiles
    int first_x, first_y;               // its first pixel, from x0, y0
    int width, height;                  // its pixels' ends, from x0, y0; at most FrameParams::tile_size
    int own_x0, own_y0, own_x1, own_y1; // its own pixels, from x0, y0; the end is exclusive
    bool whole() const { return own_x0 == 0 && own_y0 == 0 && own_x1 == width && own_y1 == height; }
    bool owns(int x, int y) const { return x >= own_x0 && x < own_x1 && y >= own_y0 && y < own_y1; }
};

// Room that a tile with a rim needs beside its own pixels: the rim on both sides, and pixels before the first to the last block's corner.
inline constexpr int kRimRoom = 2 + kBlock - 1;

// Returns the tile whose own pixels begin at left, top, and end at the latest at right, bottom.
inline TileRect tile_rect(const FrameParams& f, int left, int top, int right, int bottom)
{
    const auto least = [](int a, int b) { return a < b ? a : b; };
    const int first_x = left > f.tile_rim ? left - f.tile_rim : 0, first_y = top > f.tile_rim ? top - f.tile_rim : 0;
    const int own_x1 = least(left + f.tile_step, right), own_y1 = least(top + f.tile_step, bottom);
    TileRect r;
    r.x0 = first_x / kBlock * kBlock, r.y0 = first_y / kBlock * kBlock;
    r.first_x = first_x - r.x0, r.first_y = first_y - r.y0;
    r.width = least(own_x1 + f.tile_rim, f.width) - r.x0, r.height = least(own_y1 + f.tile_rim, f.height) - r.y0;
    r.own_x0 = left - r.x0, r.own_y0 = top - r.y0, r.own_x1 = own_x1 - r.x0, r.own_y1 = own_y1 - r.y0;
    return r;
}

inline constexpr std::int32_t kNoMaterial = -1, kManyMaterials = -2; // in place of a material

// Callback at every stage's end in a profiled tile. material: the shaded fragments' material, or -1. used, all: lanes in use, and
// their total.
struct TileClock {
    void (*lap)(TileClock& self, FrameStage stage, std::int32_t material, std::uint32_t used, std::uint32_t all);
};

// A block's sample state. An `empty` or `whole` block has no samples in memory until something else is drawn there.
enum class BlockState : std::uint8_t {
    empty, // shows no triangle
    whole, // shows one triangle: depths follow the block's plane
    drawn  // depth and ids hold the samples
};

// A triangle's depths in a block.
struct BlockPlane {
    float z, dz_x, dz_y; // at the block's corner, and their change by pixel
    float z_min, z_max;  // over the triangle's vertices: samples are clamped to this range
    std::uint32_t id;    // index into `triangles`
};

struct TileScratch;

// A tile's blended surfaces, one depth layer after another from the nearest on (depth peeling, Everitt 2001). Memory holds one layer, for
// any layer count.
struct PeelScratch {
    TileScratch* layer;        // the current layer's fragments; its triangles are the tile's
    float* alpha;              // the layer's, by fragment
    float* depth;              // [block][sample][64] in the last layer; -1 if no further layer is visible
    std::int32_t* id;          // [block][sample][64] its triangle
    float *red, *green, *blue; // [block][sample][64] blended_light::over
    float* through;            // [block][sample][64] blended_light::through
    std::uint64_t* pixels;     // [block] pixels with a blended surface
    bool* done;                // [block] no further layer
    std::uint32_t* triangles;  // blended triangles in the tile's list; from begin_layers() on the nearest first
    std::uint32_t* order;      // room for as many
    float* nearest;            // by number in the tile's list: the nearest vertex's depth
    std::uint32_t triangle_count;
    std::uint32_t passed;         // triangles at the front of the list that no further layer shows
    float nearest_open;           // greatest in `depth`
    std::uint32_t fragment_count; // in all layers, in the tile's own pixels
    float* output_through;        // the frame's [pixel][sample], or null
};

// One worker's scratch memory, sized for a tile's worst case, so tile loops never allocate.
struct TileScratch {
    float* depth;              // [block][sample][64], reversed, 0 = empty; for drawn blocks
    std::uint32_t* ids;        // [block][sample][64], index into `triangles`, or kNoTriangle; for drawn blocks
    float* block_far;          // [block] farthest depth among all samples (a lower bound)
    std::uint8_t* block_dirty; // [block] writes since block_far was exact
    BlockState* block_state;   // [block]
    BlockPlane* block_plane;   // [block] for whole blocks
    std::uint32_t triangle_count;
    const std::uint32_t* entries;    // the tile's triangles, in draw order; kLanes may be read at any entry
    TriangleSetup* triangles;        // by entry; pieces come with setups, others are made here. kLanes may be written at any entry
    const ClipRecord* clips;         // for the tile's pieces
    std::uint32_t* drawn_singly;     // triangles that lanes do not share
    std::int32_t* fragment_triangle; // visible (pixel, triangle) pairs, in list_fragments' order
    std::int32_t* fragment_pixel;    // x | y << 8, in the tile
    std::int32_t* fragment_mask;     // covered samples, bit s = sample s
    std::uint8_t* register_passes;   // by pixel register: the largest fragment count in a pixel
    std::uint32_t* pass_lanes;       // by pass: the register's pixels with a fragment in it, bit i = lane i
    float *red, *green, *blue;       // shaded colour by fragment
    float* shared_words;             // [word][shared_capacity] records that fragments share (share.h), by fragment
    float* shared_pixels;            // [plane][kSharedPixels] what each pixel shows its neighbours
    std::size_t shared_capacity;
    std::int32_t* order;            // fragments sorted by material slot
    bool in_list_order;             // `order` would hold 0, 1, 2... and is not written
    std::int32_t only_material;     // all triangles' in the tile; or kNoMaterial, kManyMaterials
    std::int32_t* slot_of_material; // by material; -1 outside a tile
    std::int32_t* slot_material;    // by slot
    std::uint32_t* slot_begin;      // by slot, into `order`
    std::uint32_t fragment_count, background_pixels;
    std::uint32_t own_fragments, own_background; // those in the tile's own pixels
    bool transmits;                              // a shaded material transmits light
    float* output;                               // the frame's RGB pixels
    std::uint32_t* output_ids;                   // the frame's triangle ids [pixel][sample], or null
    std::uint32_t *output_depths, *output_pairs; // the frame's stage records, or null
    float* output_layers;                        // the frame's layers [pixel][kLayerWords], or null
    TileClock* clock;                            // null unless the frame is profiled
    PeelScratch* peel;                           // null if no material blends
};

struct LaneWork { // by counted lanes: float sums, products, quotients and roots; bytes that loads and fetches ask for
    std::uint64_t operations, bytes;
};

struct TileFns { // one table per instruction set
    void (*transform_vertices)(const FrameParams&, std::uint32_t first, std::uint32_t count);
    void (*bin_triangles)(const FrameParams&, std::uint32_t first, std::uint32_t count, ChunkOutput&);
    // Computes the tile rectangles that entries may touch, as in TileRun. left, top: the first tile's first own pixel. Pieces get all
    // tiles. kLanes may be read and written at any entry.
    void (*touch_tiles)(const FrameParams&, int left, int top, const std::uint32_t* entries, std::uint32_t count, std::uint32_t* first_tile,
                        std::uint32_t* last_tile);
    void (*render_tile)(const FrameParams&, const TileRect&, TileScratch&);
    void (*record_vertices)(const FrameParams&, std::uint32_t count, std::uint32_t* out); // StageRecords::vertices
    LaneWork (*work)(); // the calling thread's so far; 0 for lanes that do not count
    int lanes;          // kLanes
};
BN_DECLARE_FNS(TileFns);

// Clips one triangle in homogeneous space and appends its pieces (baseline code, called from lane code for the rare triangle).
void clip_triangle(const FrameParams& frame, std::uint32_t triangle, ChunkOutput& output);

} // namespace burnish
