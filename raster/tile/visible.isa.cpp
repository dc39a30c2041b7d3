// Finds the visible triangle of every sample in a tile, and lists the fragments, sorted by material. Compiled once per instruction set.
#include "raster/tile/visible.h"

#include "raster/tile/draw_order.h"
#include "raster/tile/peel.h"
#include "raster/tile/raster.h"
#include "raster/tile/shade.h"
#include "raster/tile/small_triangles.h"
#include "raster/tile/visibility.h"

namespace burnish {
inline namespace BN_ISA_NS {

namespace {

struct OpaqueBlocks {
    static constexpr bool kTests = false;
    NoAlpha operator()(int, int) const { return {}; }
};

BN_STAGE real alpha_at(const Tile& t, const MaterialRecord& m, const view_params& view, std::int32_t id, integer x, integer y)
{
    const integer all_samples = int_lit((1 << t.f.msaa) - 1);
    return fetch_alpha(t.f, m, make_fragment_inline(t.f, m, view, t.s, int_lit(id), id, x, y, all_samples, false, false));
}

// Alpha test of one triangle in one block.
struct BlockAlpha {
    const Tile& t;
    const MaterialRecord& m;
    const view_params& view;
    std::uint32_t triangle;
    int block_x, block_y;

    // Fetches alpha for n pixels of the block, numbered row by row. Whole registers are read and written.
    void find(const std::int32_t* pixels, int n, float* to) const
    {
        const std::int32_t id = static_cast<std::int32_t>(triangle);
        const integer x0 = int_lit(t.x0 + block_x * kBlock), y0 = int_lit(t.y0 + block_y * kBlock);
        for (int i = 0; i < n; i += kLanes) { // spare lanes repeat the first pixel
            const integer pixel = select(iota() < int_lit(n - i), load_int(pixels + i), int_lit(pixels[i]));
            store(to + i, alpha_at(t, m, view, id, (pixel & int_lit(7)) + x0, shr(pixel, 3) + y0));
        }
    }
    std::uint32_t staying(real alpha) const { return to_bits(alpha_stays(m, alpha, lit(0.5))); }
};

struct AlphaBlocks {
    static constexpr bool kTests = true;
    const Tile& t;
    const MaterialRecord& m;
    const view_params& view;
    std::uint32_t triangle;
    BlockAlpha operator()(int bx, int by) const { return {t, m, view, triangle, bx, by}; }
};

BN_INLINE void note_material(TileScratch& s, std::int32_t material)
{
    s.only_material = s.only_material == kNoMaterial || s.only_material == material ? material : kManyMaterials;
}

// Lists the triangles `some` in the register from `first` on. Returns their number.
BN_INLINE std::uint32_t list_triangles(std::uint32_t some, std::uint32_t first, std::uint32_t* to)
{
    std::uint32_t n = 0;
    for (std::uint32_t bits = some; bits; bits &= bits - 1)
        to[n++] = first + static_cast<std::uint32_t>(__builtin_ctz(bits));
    return n;
}

// Returns the triangles among `used`, from `first` on, whose material blends.
std::uint32_t blended_triangles(const Tile& t, std::uint32_t first, std::uint32_t used)
{
    std::uint32_t blended = 0;
    for (std::uint32_t bits = used; bits; bits &= bits - 1) {
        const std::uint32_t lane = static_cast<std::uint32_t>(__builtin_ctz(bits));
        if (t.f.materials[t.s.triangles[first + lane].info >> 2].alpha_mode == kAlpha_blend)
            blended |= 1u << lane;
    }
    return blended;
}

// Draws a register's small triangles, and notes if there are any. The other triangles join the list of singly drawn ones.
void raster_register(const Tile& t, std::uint32_t first, Surfaces surfaces, std::uint32_t& singly, bool& some_small)
{
    TileScratch& s = t.s;
    mask whole;
    integer material;
    const LaneTriangles triangles = load_triangles(t.f, s, first, whole, material);
    std::uint32_t used = s.triangle_count - first < kLanes ? (1u << (s.triangle_count - first)) - 1 : (1u << kLanes) - 1;
    std::uint32_t small = to_bits(both(whole, small_triangles(triangles)));
    std::uint32_t rest = small; // triangles with a material not yet checked
    // Accept small triangles with opaque materials only
    while (rest) {
        const std::int32_t id = s.triangles[first + static_cast<std::uint32_t>(__builtin_ctz(rest))].info >> 2;
        const std::uint32_t same = rest & to_bits(material == int_lit(id));
        if (t.f.materials[id].alpha_mode == kAlpha_opaque)
            note_material(s, id);
        else
            small &= ~same;
        rest &= ~same;
    }
    // Move blended triangles to their list
    if (t.f.blends && surfaces == Surfaces::solid) {
        const std::uint32_t blended = blended_triangles(t, first, used & ~small);
        s.peel->triangle_count += list_triangles(blended, first, s.peel->triangles + s.peel->triangle_count);
        used &= ~blended;
    }
    singly += list_triangles(used & ~small, first, s.drawn_singly + singly);
    if (small) {
        if (!some_small) // one small triangle usually means many
            write_all_blocks(t.f, s);
        some_small = true;
        raster_small_triangles(t.f, triangles, mask_from_bits(small), t.x0, t.y0, first, s);
    }
}

template <bool kAnyOrder> void raster_singly(const Tile& t, const view_params& view, std::uint32_t count, int refresh_writes)
{
    TileScratch& s = t.s;
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t i = s.drawn_singly[k];
        const TriangleSetup& setup = s.triangles[i];
        TileTriangle triangle;
        if (!begin_triangle(t.f, setup, t.x0, t.y0, triangle))
            continue;
        triangle.refresh_writes = refresh_writes;
        const std::int32_t material = setup.info >> 2;
        note_material(s, material);
        const MaterialRecord& m = t.f.materials[material];
        if (m.alpha_mode == kAlpha_opaque)
            raster_triangle<kAnyOrder>(t.f, triangle, i, s, OpaqueBlocks{});
        else
            raster_triangle<kAnyOrder>(t.f, triangle, i, s, AlphaBlocks{t, m, view, i});
    }
}

void raster_tile(const Tile& t, const view_params& view, Surfaces surfaces)
{
    TileScratch& s = t.s;
    s.only_material = kNoMaterial;
    if (s.peel)
        s.peel->triangle_count = 0;
    std::uint32_t singly = 0;
    bool some_small = false;
    for (std::uint32_t i = 0; i < s.triangle_count; i += kLanes)
        raster_register(t, i, surfaces, singly, some_small);
    if (some_small) // the blocks' bounds are out of date
        __builtin_memset(s.block_dirty, 255, static_cast<std::size_t>((t.f.tile_size / kBlock) * (t.f.tile_size / kBlock)));
    const bool sorted = front_to_back(t.f, s, singly, t.x0, t.y0); // if early hiding pays
    if (sorted || some_small)
        raster_singly<true>(t, view, singly, sorted ? 1 : 4);
    else
        raster_singly<false>(t, view, singly, 4);
}

// Returns the global id of a triangle in the tile's list.
BN_INLINE std::uint32_t triangle_id(const TileScratch& s, std::uint32_t i)
{
    return s.entries[i] & kClippedEntry ? s.clips[s.triangles[i].vertex[0]].triangle : s.entries[i];
}

// Writes the global ids of one row in a block. Returns false, and writes nothing, if a pixel shows a clipped piece.
BN_INLINE bool write_row(const TileScratch& s, const std::uint32_t* from, std::uint32_t* to)
{
    constexpr int kStep = kLanes < kBlock ? kLanes : kBlock;
    std::int32_t row[kBlock + kLanes];
    for (int x = 0; x < kBlock; x += kStep) {
        const integer id = load_first(reinterpret_cast<const std::int32_t*>(from + x), kStep), zero = int_lit(0);
        const mask nothing = id < zero;
        const integer entry = gather_int(reinterpret_cast<const std::int32_t*>(s.entries), select(nothing, zero, id));
        if (any(both(not_(nothing), entry < zero)))
            return false;
        store_int(row + x, select(nothing, id, entry));
    }
    __builtin_memcpy(to, row, kBlock * sizeof *to);
    return true;
}

void write_ids(const Tile& t)
{
    const int blocks_x = t.f.tile_size / kBlock, msaa = t.f.msaa;
    for (int y = t.own_y0; y < t.own_y1; ++y)
        for (int bx = 0; bx * kBlock < t.own_x1; ++bx) {
            const int left = bx * kBlock, first = left < t.own_x0 ? t.own_x0 - left : 0;
            const int end = t.own_x1 - left < kBlock ? t.own_x1 - left : kBlock;
            const std::uint32_t* from = t.s.ids + (y / kBlock * blocks_x + bx) * msaa * kBlockPixels + y % kBlock * kBlock;
            std::uint32_t* to = t.s.output_ids + (static_cast<std::size_t>(t.y0 + y) * static_cast<std::size_t>(t.f.width) +
                                                  static_cast<std::size_t>(t.x0 + left + first)) *
                                                     static_cast<std::size_t>(msaa);
            if (msaa == 1 && end - first == kBlock && write_row(t.s, from, to))
                continue;
            for (int x = first; x < end; ++x)
                for (int s = 0; s < msaa; ++s) {
                    const std::uint32_t id = from[s * kBlockPixels + x];
                    *to++ = id == kNoTriangle ? kNoTriangle : triangle_id(t.s, id);
                }
        }
}

constexpr std::int32_t kBackgroundSlot = 0;

// Returns the index after the run of fragments with the triangle at `i`.
BN_INLINE std::uint32_t run_end(const std::int32_t* triangle, std::uint32_t i, std::uint32_t count)
{
    const std::int32_t id = triangle[i];
    for (++i; i + kLanes <= count && all(load_int(triangle + i) == int_lit(id)); i += kLanes) {
    }
    while (i < count && triangle[i] == id)
        ++i;
    return i;
}

// Sorts fragments if all triangles have one material. If there is only background or no background, list order is the result, and `order`
// is not written.
int split_background(TileScratch& s)
{
    const std::uint32_t count = s.fragment_count;
    s.slot_material[1] = s.only_material;
    s.slot_begin[0] = 0, s.slot_begin[1] = s.background_pixels, s.slot_begin[2] = count;
    s.in_list_order = s.background_pixels == 0 || s.background_pixels == count;
    if (s.in_list_order)
        return s.background_pixels == count ? 1 : 2;
    std::int32_t* to = s.order;
    for (const bool behind : {true, false}) // one after the other, because whole registers are written beyond the end
        for (std::uint32_t i = 0; i < count; i += kLanes) {
            const integer index = iota() + int_lit(static_cast<std::int32_t>(i));
            const mask valid = index < int_lit(static_cast<std::int32_t>(count));
            const mask nothing = load_int(s.fragment_triangle + i) < int_lit(0);
            to += compress_store_int(to, index, both(valid, behind ? nothing : not_(nothing)));
        }
    return 2;
}

// Sorts the fragments by material, stably. Returns the number of slots; slot 0 is the background.
int sort_fragments(TileScratch& s)
{
    if (s.only_material != kManyMaterials)
        return split_background(s);
    s.in_list_order = false;
    int slots = 1;
    const std::int32_t* const triangle = s.fragment_triangle;
    std::int32_t* const order = s.order;
    std::uint32_t* const slot_begin = s.slot_begin;
    const std::uint32_t count = s.fragment_count;
    const auto slot_of = [&](std::int32_t id) -> std::int32_t& { return s.slot_of_material[s.triangles[id].info >> 2]; };
    // Count fragments per slot
    slot_begin[0] = 0;
    for (std::uint32_t i = 0; i < count;) {
        const std::uint32_t end = run_end(triangle, i, count);
        std::int32_t at = kBackgroundSlot;
        if (triangle[i] >= 0) {
            std::int32_t& slot = slot_of(triangle[i]);
            if (slot < 0) {
                slot = slots;
                s.slot_material[slots] = s.triangles[triangle[i]].info >> 2;
                slot_begin[slots++] = 0;
            }
            at = slot;
        }
        slot_begin[at] += end - i;
        i = end;
    }
    // Turn counts into begins
    std::uint32_t begin = 0;
    for (int k = 0; k < slots; ++k) {
        const std::uint32_t size = slot_begin[k];
        slot_begin[k] = begin;
        begin += size;
    }
    // Place the fragments
    for (std::uint32_t i = 0; i < count;) {
        const std::uint32_t end = run_end(triangle, i, count);
        std::uint32_t& to = slot_begin[triangle[i] < 0 ? kBackgroundSlot : slot_of(triangle[i])];
        std::int32_t* const from = order + to;
        to += end - i;
        for (std::int32_t* at = from; i < end; ++i, ++at)
            *at = static_cast<std::int32_t>(i);
    }
    for (int k = slots - 1; k > 0; --k) // each slot's end is the next slot's begin
        slot_begin[k] = slot_begin[k - 1];
    slot_begin[0] = 0;
    slot_begin[slots] = count;
    for (int k = 1; k < slots; ++k)
        s.slot_of_material[s.slot_material[k]] = -1;
    return slots;
}

// Counts the fragments in the tile's own pixels.
void count_own(const Tile& t, TileScratch& s)
{
    s.own_fragments = s.fragment_count, s.own_background = s.background_pixels;
    if (t.whole())
        return;
    s.own_fragments = s.own_background = 0;
    for (std::uint32_t i = 0; i < s.fragment_count; i += kLanes) {
        const integer pixel = load_int(s.fragment_pixel + i), x = pixel & int_lit(255), y = shr(pixel, 8);
        const mask in_columns = both(x >= int_lit(t.own_x0), x < int_lit(t.own_x1));
        const mask in_rows = both(y >= int_lit(t.own_y0), y < int_lit(t.own_y1));
        const mask valid = iota() < int_lit(static_cast<std::int32_t>(s.fragment_count - i));
        const mask own = both(valid, both(in_columns, in_rows));
        const mask background = both(own, load_int(s.fragment_triangle + i) < int_lit(0));
        s.own_fragments += static_cast<std::uint32_t>(__builtin_popcount(to_bits(own)));
        s.own_background += static_cast<std::uint32_t>(__builtin_popcount(to_bits(background)));
    }
}

} // namespace

// Clear, draw, list, sort.
int find_visible(const Tile& t, const view_params& view, Surfaces surfaces)
{
    TileScratch& s = t.s;
    empty_blocks((t.f.tile_size / kBlock) * (t.f.tile_size / kBlock), s);
    lap(s, FrameStage::clear);
    raster_tile(t, view, surfaces);
    lap(s, FrameStage::coverage);
    if (surfaces == Surfaces::solid) {
        if (s.output_ids || s.output_pairs)
            write_all_blocks(t.f, s);
        if (s.output_ids)
            write_ids(t);
    }
    list_fragments(t.f, t, s);
    count_own(t, s);
    const int slots = sort_fragments(s);
    lap(s, FrameStage::visibility);
    return slots;
}

void begin_layers(const Tile& t)
{
    write_all_blocks(t.f, t.s);
    PeelScratch& peel = *t.s.peel;
    const int blocks = (t.f.tile_size / kBlock) * (t.f.tile_size / kBlock), samples = t.f.msaa * kBlockPixels;
    for (int i = 0; i < blocks * samples; i += kLanes) {
        store(peel.depth + i, lit(2.0)); // nearer than any surface
        store_int(peel.id + i, int_lit(-1));
        store(peel.red + i, lit(0.0)), store(peel.green + i, lit(0.0)), store(peel.blue + i, lit(0.0));
        store(peel.through + i, lit(1.0));
    }
    for (int block = 0; block < blocks; ++block)
        peel.pixels[block] = 0, peel.done[block] = false;
    peel.fragment_count = 0, peel.passed = 0, peel.nearest_open = 2.0f;
    // Sort the triangles
    for (std::uint32_t k = 0; k < peel.triangle_count; ++k)
        peel.nearest[peel.triangles[k]] = nearest_depth(peel.layer->triangles[peel.triangles[k]]);
    std::uint32_t* const sorted = sort_by_depth(peel.nearest, peel.triangle_count, peel.triangles, peel.order);
    peel.order = sorted == peel.triangles ? peel.order : peel.triangles;
    peel.triangles = sorted;
}

int find_layer(const Tile& t)
{
    PeelScratch& peel = *t.s.peel;
    TileScratch& layer = *peel.layer;
    begin_layer(t.f, t.s, layer);
    float farthest = 0.0f;
    std::uint32_t drawn = 0, bounded = 4; // number of triangles, doubled at each bound, so that bounds cost little
    for (std::uint32_t k = peel.passed; k < peel.triangle_count && peel.nearest[peel.triangles[k]] >= farthest; ++k) {
        const std::uint32_t i = peel.triangles[k];
        TileTriangle triangle;
        const bool touches = begin_triangle(t.f, layer.triangles[i], t.x0, t.y0, triangle);
        if (!touches || triangle.z_min > peel.nearest_open) { // before the last layer everywhere
            peel.passed += peel.passed == k;
            continue;
        }
        if (++drawn > bounded)
            farthest = farthest_of_layer(t.f, layer), bounded *= 2;
        triangle.refresh_writes = 1;
        note_material(layer, layer.triangles[i].info >> 2);
        raster_triangle<true>(t.f, triangle, i, layer, PeelBlocks{t.f, peel});
    }
    lap(layer, FrameStage::coverage);
    list_fragments(t.f, t, layer);
    count_own(t, layer);
    const int slots = sort_fragments(layer);
    lap(layer, FrameStage::visibility);
    return layer.background_pixels == layer.fragment_count ? 1 : slots;
}

} // namespace BN_ISA_NS
} // namespace burnish
