// From the colours of fragments to pixels.
#pragma once
#include "raster/tile/blocks.h"
#include "shading/surface/coverage.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

// covered_share(), of no more samples than there are.
BN_INLINE real share_of(integer samples, real each, int msaa)
{
    if (msaa <= 4)
        return to_real(count_bits4(samples)) * each;
    if (msaa <= 8)
        return to_real(count_bits4(samples & int_lit(15)) + count_bits4(shr_logical(samples, 4))) * each;
    return covered_share(samples, each);
}

// Box resolve: the mean over samples, fragments of a pixel in the order of their passes, so the sum never depends on how they were
// batched. Writes RGB to the frame.
BN_INLINE void resolve(const FrameParams& f, int x0, int y0, int width, int height, const TileScratch& s)
{
    const real each = splat(1.0f / static_cast<float>(f.msaa)), zero = lit(0.0);
    const std::uint32_t* lanes = s.pass_lanes;
    const std::uint8_t* register_passes = s.register_passes;
    const std::size_t row = 3 * static_cast<std::size_t>(f.width);
    std::uint32_t at = 0;
    for (int by = 0; by * kBlock < height; ++by)
        for (int bx = 0; bx * kBlock < width; ++bx) {
            float* const corner =
                s.output + row * static_cast<std::size_t>(y0 + by * kBlock) + 3 * static_cast<std::size_t>(x0 + bx * kBlock);
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
                    const real weight = share_of(expand_load_int(s.fragment_mask + at, m), each, f.msaa);
                    r = r + expand_load(s.red + at, m) * weight;
                    g = g + expand_load(s.green + at, m) * weight;
                    b = b + expand_load(s.blue + at, m) * weight;
                    at += static_cast<std::uint32_t>(__builtin_popcount(bits));
                    drawn |= bits;
                }
                float* const to = corner + row * static_cast<std::size_t>(v * kLanes >> 3) + 3 * (v * kLanes & 7);
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
}

} // namespace BN_ISA_NS
} // namespace burnish
