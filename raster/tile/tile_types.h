// The tile renderer's own tables: plain data, shared by the baseline code and the instruction-set objects.
// Sub-pixel units: 1/256 pixel, x right, y down, relative to the integer centre pixel of the image, so that |x|, |y| < 2^22.
#pragma once
#include <cstdint>

#include "core/simd/fns.h"
#include "raster/frame/stages.h"
#include "shading/lang/tables.h"

namespace burnish {

inline constexpr int kBlock = 8; // coverage and hierarchical depth work on 8x8 pixels
inline constexpr int kBlockPixels = kBlock * kBlock;
inline constexpr int kMaxTileSize = 64; // pixels along a side

// A vertex after transformation.
struct alignas(16) SnappedVertex {
    std::int32_t x, y; // sub-pixel units; x = kNeedsClip where the vertex has no snapped position
    float inv_w;       // 1 / clip w
    float z;           // depth, reversed: 1 near, 0 far
};

// A triangle ready to be rasterized, one cache line. Vertices run so that the area is positive with y down.
struct alignas(64) TriangleSetup {
    std::int32_t x[3], y[3]; // as SnappedVertex
    float inv_w[3];
    float z[3];
    std::int32_t vertex[3]; // into DrawTables::shading
    std::int32_t info;      // material << 2 | kFrontFacing | kClipped; vertex[0] of a clipped piece is an index into TileScratch::clips
};
static_assert(sizeof(TriangleSetup) == 64);

// Piece of a triangle that crossed the near plane or left the guard band: its corners in barycentrics of the whole one.
struct alignas(64) ClipRecord {
    float bary[9];          // corner j of the piece = sum_k bary[3j+k] * vertex k
    std::int32_t vertex[3]; // of the whole triangle
    std::uint32_t triangle; // its global id
    float pad[3];
};
static_assert(sizeof(ClipRecord) == 64);

struct ClippedPiece {
    TriangleSetup setup; // without vertices
    ClipRecord record;
};

// An entry of a list of triangles is the global id of one that is whole, below 2^31 / 3 (make_draw_tables sees to it); or kClippedEntry and
// the index of a piece.
inline constexpr std::uint32_t kClippedEntry = 1u << 31;

// Entries that follow each other and may touch the same tiles.
struct TileRun {
    std::uint32_t first_tile, last_tile; // x | y << 16: the corners of their rectangle
    std::uint32_t count;
};

struct ChunkOutput { // what one chunk of clusters produced, in draw order
    std::uint32_t* entries;
    TileRun* runs; // of all entries
    std::uint32_t count, run_count, capacity;
    ClippedPiece* pieces;
    std::uint32_t piece_count, piece_capacity;
    void (*grow)(ChunkOutput* self); // makes room for at least kGrowRoom more of each
    void* owner;
};
inline constexpr std::uint32_t kGrowRoom = 256;

// Says what tiles the next n entries may touch.
inline void add_run(ChunkOutput& out, std::uint32_t first_tile, std::uint32_t last_tile, std::uint32_t n)
{
    TileRun* const run = out.runs + out.run_count;
    if (out.run_count > 0 && run[-1].first_tile == first_tile && run[-1].last_tile == last_tile)
        run[-1].count += n;
    else
        *run = {first_tile, last_tile, n}, ++out.run_count;
}

// Everything a tile needs to know of its frame; constant while the frame is drawn.
struct FrameParams : ShadingFrame {
    std::int32_t tile_size, tiles_x, tiles_y;
    SnappedVertex* vertices; // by global vertex id
    bool blends;             // some material blends
};

inline constexpr std::int32_t kNoMaterial = -1, kManyMaterials = -2; // instead of one

// Told of the end of every stage of a tile while a frame is profiled: the material whose fragments were shaded, or -1; the lanes that
// were in use, and all of them.
struct TileClock {
    void (*lap)(TileClock& self, FrameStage stage, std::int32_t material, std::uint32_t used, std::uint32_t all);
};

// What a block's samples show. Those of an `empty` or a `whole` block are not in memory until something else is drawn there.
enum class BlockState : std::uint8_t {
    empty, // nothing
    whole, // one triangle: its depths are those of the block's plane
    drawn  // what depth and ids say
};

// The depths of a triangle in a block.
struct BlockPlane {
    float z, dz_x, dz_y; // at the block's corner, and their change by pixel
    float z_min, z_max;  // of the triangle's vertices: samples are clamped to them
    std::uint32_t id;    // index into `triangles`
};

struct TileScratch;

// Blended surfaces of a tile, one depth layer after another from the nearest on (depth peeling, Everitt 2001): memory is that of one layer,
// whatever their number.
struct PeelScratch {
    TileScratch* layer;        // fragments of the layer at hand; its triangles are the tile's
    float* alpha;              // of the layer, by fragment
    float* depth;              // [block][sample][64] of the last layer; -1 where no further one is seen
    std::int32_t* id;          // [block][sample][64] its triangle
    float *red, *green, *blue; // [block][sample][64] blended_light::over
    float* through;            // [block][sample][64] blended_light::through
    std::uint64_t* pixels;     // [block] pixels that show a blended surface
    bool* done;                // [block] no further layer
    std::uint32_t* triangles;  // blended ones of the tile's list
    std::uint32_t triangle_count;
    std::uint32_t fragment_count; // of all layers
    float* output_through;        // the frame's [pixel][sample], or null
};

// Scratch memory of one worker; sized for the worst case of a tile, so tile loops never allocate.
struct TileScratch {
    float* depth;              // [block][sample][64], reversed, 0 = nothing; only of drawn blocks
    std::uint32_t* ids;        // [block][sample][64], index into `triangles`, or kNoTriangle; only of drawn blocks
    float* block_far;          // [block] farthest depth among all samples (a lower bound)
    std::uint8_t* block_dirty; // [block] writes since block_far was true
    BlockState* block_state;   // [block]
    BlockPlane* block_plane;   // [block] of whole ones
    std::uint32_t triangle_count;
    const std::uint32_t* entries;    // the tile's triangles, in draw order; kLanes may be read at any of them
    TriangleSetup* triangles;        // by entry; those of pieces are given, the others are made here. kLanes may be written at any of them
    const ClipRecord* clips;         // of the tile's pieces
    std::uint32_t* drawn_singly;     // triangles that lanes do not share
    std::int32_t* fragment_triangle; // visible (pixel, triangle) pairs, in the order of list_fragments
    std::int32_t* fragment_pixel;    // x | y << 8, in the tile
    std::int32_t* fragment_mask;     // covered samples, bit s = sample s
    std::uint8_t* register_passes;   // by register of pixels: how many fragments its fullest pixel has
    std::uint32_t* pass_lanes;       // by pass: the pixels of the register that have a fragment in it, bit i = lane i
    float *red, *green, *blue;       // shaded colour by fragment
    float* lines;                    // [fragment][16] line_record (shading/techniques/shared_line.k.h), of those that share samples
    std::int32_t* sharing_of_pixel;  // [64 y + x] its first fragment that shares, or -1
    std::int32_t* next_sharing;      // by fragment: the pixel's next one, in the order of passes, or -1
    std::int32_t* order;             // fragments sorted by material slot
    bool in_list_order;              // `order` would hold 0, 1, 2... and is not written
    std::int32_t only_material;      // of all triangles of the tile; or kNoMaterial, kManyMaterials
    std::int32_t* slot_of_material;  // by material; -1 outside of a tile
    std::int32_t* slot_material;     // by slot
    std::uint32_t* slot_begin;       // by slot, into `order`
    std::uint32_t fragment_count, background_pixels;
    float* output;                               // the frame's RGB pixels
    std::uint32_t* output_ids;                   // the frame's triangle ids [pixel][sample], or null
    std::uint32_t *output_depths, *output_pairs; // its stage records, or null
    float* output_layers;                        // [pixel][kLayerWords] its layers, or null
    TileClock* clock;                            // null unless the frame is profiled
    PeelScratch* peel;                           // null where no material blends
};

struct TileFns { // one table an instruction set
    void (*transform_vertices)(const FrameParams&, std::uint32_t first, std::uint32_t count);
    void (*bin_triangles)(const FrameParams&, std::uint32_t first, std::uint32_t count, ChunkOutput&);
    // The corners of the rectangles of tiles that entries may touch, as in TileRun; those of pieces: all tiles. kLanes may be read and
    // written at any of them.
    void (*touch_tiles)(const FrameParams&, const std::uint32_t* entries, std::uint32_t count, std::uint32_t* first_tile,
                        std::uint32_t* last_tile);
    void (*render_tile)(const FrameParams&, int tile_x, int tile_y, TileScratch&);
    void (*record_vertices)(const FrameParams&, std::uint32_t count, std::uint32_t* out); // StageRecords::vertices
    int lanes;                                                                            // kLanes
};
BN_DECLARE_FNS(TileFns);

// Clips one triangle in homogeneous space and appends its pieces (baseline code, called from the lanes for the rare triangle).
void clip_triangle(const FrameParams& frame, std::uint32_t triangle, ChunkOutput& output);

} // namespace burnish
