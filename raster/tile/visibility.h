// From triangle ids by sample to the list of visible (pixel, triangle) pairs, and from their colours back to pixels.
#pragma once
#include "raster/tile/raster.h"

namespace burnish {
inline namespace BN_ISA_NS {

// One pixel whose samples differ: a fragment for each distinct triangle, in the order of first appearance.
BN_INLINE void list_mixed_pixel(const std::uint32_t* ids, int msaa, std::int32_t pixel, TileScratch& s)
{
    std::uint32_t rest = (1u << msaa) - 1;
    while (rest) {
        const std::uint32_t id = ids[__builtin_ctz(rest) * kBlockPixels];
        std::uint32_t covered = 0;
        for (std::uint32_t r = rest; r; r &= r - 1) {
            const int sample = __builtin_ctz(r);
            covered |= ids[sample * kBlockPixels] == id ? 1u << sample : 0u;
        }
        rest &= ~covered;
        s.fragment_triangle[s.fragment_count] = static_cast<std::int32_t>(id);
        s.fragment_pixel[s.fragment_count] = pixel;
        s.fragment_mask[s.fragment_count] = static_cast<std::int32_t>(covered);
        ++s.fragment_count;
    }
}

// Lists the fragments of the tile's width x height pixels, block by block, pixel by pixel.
BN_INLINE void list_fragments(const FrameParams& f, int width, int height, TileScratch& s)
{
    const int blocks_x = f.tile_size / kBlock;
    const std::int32_t full = static_cast<std::int32_t>((1u << f.msaa) - 1);
    s.fragment_count = 0;
    for (int by = 0; by * kBlock < height; ++by)
        for (int bx = 0; bx * kBlock < width; ++bx) {
            const std::uint32_t* ids = s.ids + (by * blocks_x + bx) * f.msaa * kBlockPixels;
            for (int v = 0; v < kVectors; ++v) {
                const integer lane = iota() + int_lit(v * kLanes);
                const integer x = (lane & int_lit(7)) + int_lit(bx * kBlock), y = shr(lane, 3) + int_lit(by * kBlock);
                const mask valid = both(x < int_lit(width), y < int_lit(height));
                const std::int32_t* from = reinterpret_cast<const std::int32_t*>(ids) + v * kLanes;
                const integer first = load_int(from);
                mask same = valid;
                for (int i = 1; i < f.msaa; ++i)
                    same = both(same, load_int(from + i * kBlockPixels) == first);
                const integer pixel = x | shl(y, 8);
                if (all(same)) {
                    store_int(s.fragment_triangle + s.fragment_count, first);
                    store_int(s.fragment_pixel + s.fragment_count, pixel);
                    store_int(s.fragment_mask + s.fragment_count, int_lit(full));
                    s.fragment_count += kLanes;
                    continue;
                }
                std::int32_t pixels[kLanes];
                store_int(pixels, pixel);
                for (std::uint32_t bits = to_bits(valid); bits; bits &= bits - 1) {
                    const int i = __builtin_ctz(bits);
                    list_mixed_pixel(ids + v * kLanes + i, f.msaa, pixels[i], s);
                }
            }
        }
}

BN_INLINE bool whole_row(const std::int32_t* masks, std::int32_t full)
{
    std::int32_t common = full;
    for (int k = 0; k < kBlock; ++k)
        common &= masks[k];
    return common == full;
}

// Box resolve: the mean over samples, fragments of a pixel in the order of the list, so the sum never depends on how they were
// batched. Writes RGB to the frame.
BN_INLINE void resolve(const FrameParams& f, int x0, int y0, const TileScratch& s)
{
    const float inv = 1.0f / static_cast<float>(f.msaa);
    const std::int32_t full = static_cast<std::int32_t>((1u << f.msaa) - 1);
    for (std::uint32_t i = 0; i < s.fragment_count;) {
        const std::int32_t pixel = s.fragment_pixel[i];
        // a row of a block without edges: every pixel is one fragment of weight 1
        if (i + kBlock <= s.fragment_count && s.fragment_pixel[i + kBlock - 1] - pixel == kBlock - 1 && whole_row(s.fragment_mask + i, full)) {
            float* to = s.output + 3 * (static_cast<std::size_t>(y0 + (pixel >> 8)) * static_cast<std::size_t>(f.width) +
                                        static_cast<std::size_t>(x0 + (pixel & 255)));
            for (std::uint32_t k = 0; k < kBlock; ++k)
                to[3 * k] = 0.0f + s.red[i + k], to[3 * k + 1] = 0.0f + s.green[i + k], to[3 * k + 2] = 0.0f + s.blue[i + k];
            i += kBlock;
            continue;
        }
        const std::size_t at = static_cast<std::size_t>(y0 + (pixel >> 8)) * static_cast<std::size_t>(f.width) +
                               static_cast<std::size_t>(x0 + (pixel & 255));
        float* to = s.output + 3 * at;
        float r = 0.0f, g = 0.0f, b = 0.0f;
        do {
            const float weight = static_cast<float>(__builtin_popcount(static_cast<unsigned>(s.fragment_mask[i]))) * inv;
            r = r + s.red[i] * weight, g = g + s.green[i] * weight, b = b + s.blue[i] * weight;
            ++i;
        } while (i < s.fragment_count && s.fragment_pixel[i] == pixel);
        to[0] = r, to[1] = g, to[2] = b;
    }
}

} // namespace BN_ISA_NS
} // namespace burnish
