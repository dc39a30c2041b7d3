// From triangle ids by sample to the list of visible (pixel, triangle) pairs, and from their colours back to pixels.
#pragma once
#include "raster/tile/raster.h"

namespace burnish {
inline namespace BN_ISA_NS {

inline constexpr std::uint32_t kAllLanes = (1u << kLanes) - 1;

// Lists the fragments of the tile's width x height pixels: by block, by register of pixels, then by pass, where pass k holds the k-th
// distinct triangle of every pixel that has one, in the order of its samples.
BN_INLINE void list_fragments(const FrameParams& f, int width, int height, TileScratch& s)
{
    const int blocks_x = f.tile_size / kBlock;
    const std::int32_t full = static_cast<std::int32_t>((1u << f.msaa) - 1);
    const integer zero = int_lit(0);
    std::uint32_t count = 0, passes = 0, background = 0;
    std::uint8_t* register_passes = s.register_passes;
    for (int by = 0; by * kBlock < height; ++by)
        for (int bx = 0; bx * kBlock < width; ++bx) {
            const std::int32_t* ids = reinterpret_cast<const std::int32_t*>(s.ids) + (by * blocks_x + bx) * f.msaa * kBlockPixels;
            for (int v = 0; v < kVectors; ++v, ++register_passes) {
                const integer lane = iota() + int_lit(v * kLanes);
                const integer x = (lane & int_lit(7)) + int_lit(bx * kBlock), y = shr(lane, 3) + int_lit(by * kBlock);
                const mask valid = both(x < int_lit(width), y < int_lit(height));
                const std::int32_t* from = ids + v * kLanes;
                const integer first = load_int(from), pixel = x | shl(y, 8);
                mask same = valid;
                for (int i = 1; i < f.msaa; ++i)
                    same = both(same, load_int(from + i * kBlockPixels) == first);
                if (all(same)) {
                    store_int(s.fragment_triangle + count, first);
                    store_int(s.fragment_pixel + count, pixel);
                    store_int(s.fragment_mask + count, int_lit(full));
                    background += static_cast<std::uint32_t>(__builtin_popcount(to_bits(first < zero)));
                    s.pass_lanes[passes++] = kAllLanes;
                    *register_passes = 1;
                    count += kLanes;
                    continue;
                }
                *register_passes = 0;
                integer rest = select(valid, int_lit(full), zero); // samples without a fragment
                for (mask some = rest != zero; any(some); some = rest != zero) {
                    integer id = int_lit(-2); // of no sample
                    for (int i = f.msaa - 1; i >= 0; --i)
                        id = select((rest & int_lit(1 << i)) != zero, load_int(from + i * kBlockPixels), id);
                    integer covered = zero;
                    for (int i = 0; i < f.msaa; ++i)
                        covered = covered | select(load_int(from + i * kBlockPixels) == id, int_lit(1 << i), zero);
                    compress_store_int(s.fragment_triangle + count, id, some);
                    compress_store_int(s.fragment_mask + count, covered, some);
                    count += static_cast<std::uint32_t>(compress_store_int(s.fragment_pixel + count, pixel, some));
                    background += static_cast<std::uint32_t>(__builtin_popcount(to_bits(both(some, id < zero))));
                    s.pass_lanes[passes++] = to_bits(some);
                    ++*register_passes;
                    rest = rest & ~covered;
                }
            }
        }
    s.fragment_count = count, s.background_pixels = background;
}

BN_INLINE real popcount16(integer i)
{
    i = i - (shr_logical(i, 1) & int_lit(0x5555));
    i = (i & int_lit(0x3333)) + (shr_logical(i, 2) & int_lit(0x3333));
    i = (i + shr_logical(i, 4)) & int_lit(0x0f0f);
    return to_real((i + shr_logical(i, 8)) & int_lit(0x1f));
}

// Box resolve: the mean over samples, fragments of a pixel in the order of their passes, so the sum never depends on how they were
// batched. Writes RGB to the frame.
BN_INLINE void resolve(const FrameParams& f, int x0, int y0, int width, int height, const TileScratch& s)
{
    const real inv = splat(1.0f / static_cast<float>(f.msaa)), zero = lit(0.0);
    const std::uint32_t* lanes = s.pass_lanes;
    const std::uint8_t* register_passes = s.register_passes;
    const std::size_t row = 3 * static_cast<std::size_t>(f.width);
    std::uint32_t at = 0;
    for (int by = 0; by * kBlock < height; ++by)
        for (int bx = 0; bx * kBlock < width; ++bx)
            for (int v = 0; v < kVectors; ++v, ++register_passes) {
                real r = zero, g = zero, b = zero;
                std::uint32_t drawn = 0;
                int passes = *register_passes;
                if (passes == 1 && *lanes == kAllLanes) { // every pixel is one fragment, of weight 1
                    r = r + load(s.red + at), g = g + load(s.green + at), b = b + load(s.blue + at);
                    at += kLanes;
                    drawn = *lanes++;
                    passes = 0;
                }
                for (int k = 0; k < passes; ++k) {
                    const std::uint32_t bits = *lanes++;
                    const mask m = mask_from_bits(bits);
                    const real weight = popcount16(expand_load_int(s.fragment_mask + at, m)) * inv;
                    r = r + expand_load(s.red + at, m) * weight;
                    g = g + expand_load(s.green + at, m) * weight;
                    b = b + expand_load(s.blue + at, m) * weight;
                    at += static_cast<std::uint32_t>(__builtin_popcount(bits));
                    drawn |= bits;
                }
                const int px = bx * kBlock + (v * kLanes & 7), py = by * kBlock + (v * kLanes >> 3);
                float* to = s.output + row * static_cast<std::size_t>(y0 + py) + 3 * static_cast<std::size_t>(x0 + px);
                if (drawn == kAllLanes) {
                    store_triples(to, to + row, r, g, b);
                    continue;
                }
                float part[2][3 * kBlock];
                store_triples(part[0], part[1], r, g, b);
                for (std::uint32_t bits = drawn; bits; bits &= bits - 1) { // at the image's border
                    const int i = __builtin_ctz(bits), y = i / kBlock, x = i % kBlock;
                    for (int c = 0; c < 3; ++c)
                        to[row * static_cast<std::size_t>(y) + static_cast<std::size_t>(3 * x + c)] = part[y][3 * x + c];
                }
            }
}

} // namespace BN_ISA_NS
} // namespace burnish
