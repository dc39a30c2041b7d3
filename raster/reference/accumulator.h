// The state of a picture in the making: running mean and variance of every pixel, and how many passes each block of pixels has had.
// Blocks go ahead on their own, so work can stop between any two of them and lose nothing.
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

PixelBlock block_of(const Accumulator& a, std::size_t index, std::uint32_t until_pass);
std::uint32_t least_passes(const Accumulator& a); // of any block
std::uint32_t most_passes(const Accumulator& a);

Image mean_image(const Accumulator& a);     // f32 RGB
Image variance_image(const Accumulator& a); // of the mean, f32 RGB; a pixel of fewer than two passes is infinite

// Half width of the 95 % confidence interval over the mean, sums of the channels, averaged over the pixels that are not black. Infinite
// below two passes. Student's t, since passes may be few.
double mean_relative_error(const Accumulator& a);
double student_t_975(std::uint32_t degrees); // of freedom: 2.5 % lie above it

} // namespace burnish
