// An unfinished picture's state: partial sums per pixel, and the pass count per pixel block. Blocks advance independently, so work
// can stop between any two blocks without loss. Passes are summed in a binary tree (add_sum() in reference_types.h), so sums over 2^k
// passes may come from anywhere.
#pragma once
#include <cstdint>
#include <vector>

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
    std::size_t first_pixel = 0, pixels = 0; // that the columns hold, row-major
    std::uint32_t first_pass = 0;            // of the sums
    std::vector<Column<PixelState>> sums;    // kMostSums: over 2^k passes, by pixel; empty where no block's passes have bit k
    Column<std::uint32_t> passes;            // by block, row-major
    std::uint32_t last_passes = 0;           // blocks with so many have totals in place of sums; 0: none
    Column<PixelState> totals;               // by pixel
};

// Restricts a new accumulator's columns to some blocks' rows: a picture's part takes memory and time by its own size.
void hold_blocks(Accumulator& a, std::size_t first, std::size_t count);

// Keeps totals alone for blocks that reach `passes`, after which nothing is added to them. Sums with several sizes would take more memory.
void keep_totals(Accumulator& a, std::uint32_t passes);

// Allocates sums for `passes`' bits.
void reserve_sums(Accumulator& a, std::uint32_t passes);
// Frees the sums that no block has.
void free_sums(Accumulator& a);
// Returns the bits that are set in some block's passes.
std::uint32_t bits_of_passes(const Accumulator& a);
// Returns a pixel's state over all its block's passes.
PixelState state_of_pixel(const Accumulator& a, std::size_t pixel);

// Returns block `index` with the passes that it lacks up to `until`.
PixelBlock block_of(const Accumulator& a, std::size_t index, std::uint32_t until);
std::uint32_t least_passes(const Accumulator& a);                                       // minimum over the blocks
std::uint32_t least_passes(const Accumulator& a, std::size_t first, std::size_t count); // over some
std::uint32_t most_passes(const Accumulator& a);

Image mean_image(const Accumulator& a);     // f32 RGB
Image variance_image(const Accumulator& a); // the mean's, f32 RGB; infinite for a pixel with fewer than two passes

// Returns the 95 % confidence interval's half width over the mean, for the channels' sum, averaged over pixels that are not black.
// Infinite below two passes. Uses Student's t, since passes may be few.
double mean_relative_error(const Accumulator& a);
double student_t_975(std::uint32_t degrees); // 97.5 % quantile by degrees of freedom

} // namespace burnish
