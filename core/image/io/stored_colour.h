// Colour spaces that files declare, and conversion to linear Rec.709.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"

namespace burnish {

// CIE xy of red, green, blue and white, in this order.
using Primaries = std::array<double, 8>;
constexpr Primaries kRec709Primaries = {0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290};

struct StoredColour {
    std::optional<Primaries> primaries;     // empty: Rec.709, or not declared
    std::array<double, 3> gain = {1, 1, 1}; // radiance = stored value * gain
    std::vector<std::string> warnings;      // one line each, for readers of colours
    std::vector<std::uint8_t> profile;      // ICC profile of a format that stores display colours
    bool deflated = false;                  // the profile is a zlib stream
};

// Returns the row-major matrix from RGB to linear Rec.709, with Bradford white adaptation. Nothing where the primaries
// span no colours.
std::optional<std::array<double, 9>> matrix_to_rec709(const Primaries& from);

// Returns true where all coordinates equal Rec.709 within the rounding in files.
bool is_rec709(const Primaries& primaries);

// Returns the luminance of red, green and blue; the sum is 1. Returns Rec.709's where the primaries span no colours.
std::array<double, 3> luminance_weights(const Primaries& primaries);

// Multiplies a float image's colours by the gain. Does nothing for a gain of 1.
void apply_gain(Image& image, const std::array<double, 3>& gain);

// Converts a float image's RGB to linear Rec.709. Pixels with NaN or infinite values stay unchanged.
void apply_matrix(Image& image, const std::array<double, 9>& to_rec709);

// Sets a float image's negative colours, which lie outside Rec.709, to 0: reflectance and light are never below 0.
// Returns the number of changed pixels.
std::size_t clip_negative_colours(Image& image);

// Converts a float image from Y, RY, BY (and alpha) to RGB: R = (RY + 1) Y, B = (BY + 1) Y, and G from the luminance
// weights.
void decode_luminance_chroma(Image& image, const std::array<double, 3>& weights);

} // namespace burnish
