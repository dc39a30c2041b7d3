// Splits pictures into bands of rows, so that buffers and images fit every device's limits, and indices fit 32 bits.
#pragma once
#include <cstdint>
#include <vector>

#include "raster/vulkan/context.h"

namespace burnish {

struct Band {
    int first_row = 0, rows = 0;    // drawn rows
    int own_begin = 0, own_end = 0; // rows that belong to this band alone, from first_row; the other ones are neighbours of these
};
inline constexpr int kBandRim = 2; // neighbours above and below where fragments share samples: one row, and one for 2x2 quads

// Bytes in a band's buffer: the least storage buffer that a Vulkan device must accept.
inline constexpr std::size_t kBandBytes = std::size_t{1} << 27;
inline constexpr std::size_t kMostBytesAPixel = 16 * 64 * 4; // 16 samples of recorded words (forward.h)
static_assert(kBandBytes / (kMostBytesAPixel * 16384) >= 2, "the widest picture without rims has bands");

// Returns the rows of a band: an even number, for 2x2 quads, or all rows; at least two beside both rims. bytes: per pixel in the largest
// buffer.
int band_rows(int width, int height, std::size_t bytes, std::size_t band_bytes, int rim);
std::vector<Band> bands_of(int height, int rows, int rim);

// A band's own pixels.
struct OwnPixels {
    std::size_t first;  // in the picture
    std::size_t skip;   // pixels before them in the band
    std::size_t pixels; // their number
    std::size_t drawn;  // all of the band
};
OwnPixels own_pixels(int width, const Band& band);

// Throws ExitCode::unavailable where a device takes less of something than is needed. limit: the API's name of it.
void require_limit(const Context& context, const char* field, const char* limit, std::uint64_t need, std::uint64_t have);
// Requires the limits that pictures of this width need.
void require_width(const Context& context, int width);

} // namespace burnish
