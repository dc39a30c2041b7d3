// Converts triangle ids per sample to a list of visible (pixel, triangle) pairs.
#pragma once
#include "raster/tile/blocks.h"

namespace burnish {
inline namespace BN_ISA_NS {

// A growing fragment list, ordered by block, by register of pixels, then by pass. Pass k holds each pixel's k-th distinct triangle, in
// sample order.
struct FragmentList {
    std::int32_t *triangle, *pixels, *masks; // of the next fragment
    std::uint32_t* pass_lanes;               // of the next pass
    std::uint8_t* register_passes;           // of the current register
    std::int32_t full;                       // mask of all samples
    std::uint32_t background = 0;

    // Adds a register in which every pixel is one fragment.
    void add_register(integer id, integer pixel)
    {
        store_int(triangle, id);
        store_int(pixels, pixel);
        store_int(masks, int_lit(full));
        triangle += kLanes, pixels += kLanes, masks += kLanes;
        *pass_lanes++ = kAllLanes;
        *register_passes++ = 1;
    }
    void add_pass(integer id, integer pixel, integer samples, mask some)
    {
        const int n = compress_store_int(triangle, id, some);
        compress_store_int(pixels, pixel, some);
        compress_store_int(masks, samples, some);
        triangle += n, pixels += n, masks += n;
        background += static_cast<std::uint32_t>(__builtin_popcount(to_bits(both(some, id < int_lit(0)))));
        *pass_lanes++ = to_bits(some);
    }
};

// Lists one pixel register. valid: pixels in the tile. from: the first sample's ids.
BN_INLINE void list_register(const FrameParams& f, const std::int32_t* from, integer pixel, mask valid, FragmentList& list)
{
    const integer zero = int_lit(0), full = int_lit(list.full), first = load_int(from);
    integer covered = int_lit(1), second = first; // samples equal to the first; the first of the other ids
    for (int i = f.msaa - 1; i > 0; --i) {
        const integer id = load_int(from + i * kBlockPixels);
        const mask same = id == first;
        covered = covered | select(same, int_lit(1 << i), zero);
        second = select(same, second, id);
    }
    // One triangle covers all pixels
    if (all(both(valid, covered == full))) {
        list.background += static_cast<std::uint32_t>(__builtin_popcount(to_bits(first < zero)));
        list.add_register(first, pixel);
        return;
    }
    // List the first triangles, then others until no sample is left
    const std::uint32_t* const first_pass = list.pass_lanes;
    if (any(valid))
        list.add_pass(first, pixel, covered, valid);
    integer rest = select(valid, full & ~covered, zero), id = second; // samples without a fragment
    while (any(rest != zero)) {
        covered = zero;
        for (int i = 1; i < f.msaa; ++i)
            covered = covered | select(load_int(from + i * kBlockPixels) == id, int_lit(1 << i), zero);
        list.add_pass(id, pixel, covered, rest != zero);
        rest = rest & ~covered;
        if (none(rest != zero)) // common case
            break;
        id = int_lit(-2); // no sample's id
        for (int i = f.msaa - 1; i > 0; --i)
            id = select((rest & int_lit(1 << i)) != zero, load_int(from + i * kBlockPixels), id);
    }
    *list.register_passes++ = static_cast<std::uint8_t>(list.pass_lanes - first_pass);
}

// Lists the fragments of the tile's pixels.
BN_INLINE void list_fragments(const FrameParams& f, const TileRect& tile, TileScratch& s)
{
    const int width = tile.width, height = tile.height;
    const int blocks_x = f.tile_size / kBlock;
    FragmentList list = {s.fragment_triangle, s.fragment_pixel,  s.fragment_mask,
                         s.pass_lanes,        s.register_passes, static_cast<std::int32_t>((1u << f.msaa) - 1)};
    for (int by = 0; by * kBlock < height; ++by)
        for (int bx = 0; bx * kBlock < width; ++bx) {
            const int block = by * blocks_x + bx;
            // Deferred blocks need no samples, except at the tile's border
            const BlockState state = s.block_state[block];
            const bool from_first = bx * kBlock >= tile.first_x && by * kBlock >= tile.first_y;
            const bool inside = from_first && (bx + 1) * kBlock <= width && (by + 1) * kBlock <= height;
            if (state != BlockState::drawn && !inside)
                write_block(f, block, s);
            const std::int32_t* ids = reinterpret_cast<const std::int32_t*>(s.ids) + block * f.msaa * kBlockPixels;
            const integer id = int_lit(state == BlockState::whole ? static_cast<std::int32_t>(s.block_plane[block].id) : -1);
            if (state == BlockState::empty && inside)
                list.background += kBlockPixels;
            for (int v = 0; v < kVectors; ++v) {
                const integer lane = iota() + int_lit(v * kLanes);
                const integer x = (lane & int_lit(7)) + int_lit(bx * kBlock), y = shr(lane, 3) + int_lit(by * kBlock);
                const integer pixel = x | shl(y, 8);
                if (state != BlockState::drawn && inside)
                    list.add_register(id, pixel);
                else
                    list_register(
                        f, ids + v * kLanes, pixel,
                        both(both(x >= int_lit(tile.first_x), x < int_lit(width)), both(y >= int_lit(tile.first_y), y < int_lit(height))),
                        list);
            }
        }
    s.fragment_count = static_cast<std::uint32_t>(list.triangle - s.fragment_triangle), s.background_pixels = list.background;
}

} // namespace BN_ISA_NS
} // namespace burnish
