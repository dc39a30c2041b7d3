// State of an unfinished picture: running mean and variance per pixel, and the number of passes per pixel block. Blocks advance
// independently, so work can stop between any two blocks without loss.
#pragma once
#include <cstdint>

#include "core/base/column.h"
#include "core/image/image.h"
#include "raster/reference/reference_types.h"

namespace burnish {

inline constexpr int kBlockSide = 8; // pixels

struct Accumulator {
    Accumulator() = default;
    Accumulator(int width, int height);
    int width = 0, height = 0;
    int blocks_x = 0, blocks_y = 0;
    Column<PixelState> pixels;    // row-major
    Column<std::uint32_t> passes; // by block, row-major
};

// Returns block `index` with the passes that it lacks up to `until_pass`.
PixelBlock block_of(const Accumulator& a, std::size_t index, std::uint32_t until_pass);
std::uint32_t least_passes(const Accumulator& a);                                       // minimum over the blocks
std::uint32_t least_passes(const Accumulator& a, std::size_t first, std::size_t count); // over some
std::uint32_t most_passes(const Accumulator& a);

Image mean_image(const Accumulator& a);     // f32 RGB
Image variance_image(const Accumulator& a); // of the mean, f32 RGB; infinite for a pixel with fewer than two passes

// Returns the half width of the 95 % confidence interval over the mean, for the channels' sum, averaged over pixels that are not black.
// Infinite below two passes. Uses Student's t, since passes may be few.
double mean_relative_error(const Accumulator& a);
double student_t_975(std::uint32_t degrees); // 97.5 % quantile by degrees of freedom

} // namespace burnish
