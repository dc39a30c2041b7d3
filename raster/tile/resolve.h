// Resolves fragment colours to pixels.
#pragma once
#include "raster/tile/blocks.h"
#include "shading/surface/coverage.t.h"

namespace burnish {
inline namespace BN_ISA_NS {

// Returns covered_share(), with code for small sample counts.
BN_INLINE real share_of(integer samples, real each, int msaa)
{
    if (msaa <= 4)
        return to_real(count_bits4(samples)) * each;
    if (msaa <= 8)
        return to_real(count_bits4(samples & int_lit(15)) + count_bits4(shr_logical(samples, 4))) * each;
    return covered_share(samples, each);
}

// Two adjacent blocks, by row: whole cache lines if the image's rows start on a cache line.
struct PixelRows {
    static constexpr int kPixels = 2 * kBlock, kFloats = 3 * kPixels;
    alignas(64) float rgb[kBlock][kFloats];
};
static_assert(PixelRows::kFloats * sizeof(float) % 64 == 0);

struct PixelRange { // the end is exclusive
    int begin, end;
};

// Returns the part of a range that lies in [from, from + size), from `from` on.
BN_INLINE PixelRange part_of(PixelRange r, int from, int size)
{
    return {r.begin > from ? r.begin - from : 0, r.end - from < size ? r.end - from : size};
}

// Writes columns of rows to the picture. to: the place of column 0 in row 0. lines: `to` and each later row start on a cache line. Then
// whole rows bypass the caches, and memory is not read before it is overwritten.
BN_INLINE void write_rows(const PixelRows& rows, PixelRange columns, PixelRange count, bool lines, float* to, std::size_t stride)
{
    const bool whole = columns.begin == 0 && columns.end == PixelRows::kPixels;
    const std::size_t floats = 3 * static_cast<std::size_t>(columns.end > columns.begin ? columns.end - columns.begin : 0);
    const float* from = rows.rgb[0] + PixelRows::kFloats * count.begin + 3 * columns.begin;
    to += stride * static_cast<std::size_t>(count.begin) + 3 * static_cast<std::size_t>(columns.begin);
    for (int y = count.begin; y < count.end; ++y, from += PixelRows::kFloats, to += stride) {
        if (whole && lines)
            stream_lines(to, from, PixelRows::kFloats);
        else if (whole)
            __builtin_memcpy(to, from, PixelRows::kFloats * sizeof(float));
        else
            __builtin_memcpy(to, from, floats * sizeof(float));
    }
}

// Box filter: averages samples. A pixel's fragments are summed in pass order, so the sum does not depend on batches. Writes RGB of the
// tile's own pixels to the frame.
BN_INLINE void resolve(const FrameParams& f, const TileRect& tile, const TileScratch& s)
{
    const real each = splat(1.0f / static_cast<float>(f.msaa)), zero = lit(0.0);
    const std::uint32_t* lanes = s.pass_lanes;
    const std::uint8_t* register_passes = s.register_passes;
    const std::size_t stride = 3 * static_cast<std::size_t>(f.width);
    float* const corner = s.output + stride * static_cast<std::size_t>(tile.y0) + 3 * static_cast<std::size_t>(tile.x0);
    const bool lines = f.width % PixelRows::kPixels == 0 && reinterpret_cast<std::uintptr_t>(corner) % 64 == 0;
    PixelRows rows;
    std::uint32_t at = 0;
    for (int by = 0; by * kBlock < tile.height; ++by)
        for (int bx = 0; bx * kBlock < tile.width; ++bx) {
            float* const block = rows.rgb[0] + 3 * kBlock * (bx & 1);
            for (int v = 0; v < kVectors; ++v, ++register_passes) {
                real r = zero, g = zero, b = zero;
                int passes = *register_passes;
                if (passes == 1 && *lanes == kAllLanes) { // every pixel is one fragment with weight 1
                    r = r + load(s.red + at), g = g + load(s.green + at), b = b + load(s.blue + at);
                    at += kLanes;
                    ++lanes;
                    passes = 0;
                }
                // Add weighted fragments, pass by pass
                for (int k = 0; k < passes; ++k) {
                    const std::uint32_t bits = *lanes++;
                    const mask m = mask_from_bits(bits);
                    const real weight = share_of(expand_load_int(s.fragment_mask + at, m), each, f.msaa);
                    r = r + expand_load(s.red + at, m) * weight;
                    g = g + expand_load(s.green + at, m) * weight;
                    b = b + expand_load(s.blue + at, m) * weight;
                    at += static_cast<std::uint32_t>(__builtin_popcount(bits));
                }
                float* const to = block + PixelRows::kFloats * (v * kLanes >> 3) + 3 * (v * kLanes & 7);
                store_triples(to, to + PixelRows::kFloats, r, g, b);
            }
            // Write a finished pair of blocks
            const int left = (bx & ~1) * kBlock, top = by * kBlock;
            if ((bx & 1) || tile.width - left <= kBlock)
                write_rows(rows, part_of({tile.own_x0, tile.own_x1}, left, PixelRows::kPixels),
                           part_of({tile.own_y0, tile.own_y1}, top, kBlock), lines,
                           corner + stride * static_cast<std::size_t>(top) + 3 * left, stride);
        }
    stream_fence();
}

} // namespace BN_ISA_NS
} // namespace burnish
