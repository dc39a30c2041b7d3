// The colours that a file says its numbers are, and how they become linear Rec.709.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"

namespace burnish {

// CIE xy of red, green, blue and white, in this order.
using Primaries = std::array<double, 8>;
constexpr Primaries kRec709Primaries = {0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290};

struct StoredColour {
    std::optional<Primaries> primaries;     // none: Rec.709, or the file does not say
    std::array<double, 3> gain = {1, 1, 1}; // the file's values times these are radiance
    std::vector<std::string> warnings;      // one line each, of interest to readers of colours
};

// Row-major RGB to linear Rec.709; white is adapted by Bradford's method. Nothing where the primaries span no colours.
std::optional<std::array<double, 9>> matrix_to_rec709(const Primaries& from);

// True where all coordinates are those of Rec.709 within what files round.
bool is_rec709(const Primaries& primaries);

// Luminance of red, green and blue; their sum is 1. Those of Rec.709 where the primaries span no colours.
std::array<double, 3> luminance_weights(const Primaries& primaries);

// Multiplies the colours of a float picture by the gain. Does nothing where it is 1.
void apply_gain(Image& image, const std::array<double, 3>& gain);

// Turns RGB of a float picture into linear Rec.709. Pixels with NaN or infinite values stay as they are.
void apply_matrix(Image& image, const std::array<double, 9>& to_rec709);

// Sets negative colours of a float picture, which lie outside Rec.709, to 0: neither reflectance nor light is below it. Returns the number
// of pixels.
std::size_t clip_negative_colours(Image& image);

// Turns Y, RY, BY (and alpha) of a float picture into RGB: R = (RY + 1) Y, B = (BY + 1) Y, and G by the luminance weights.
void decode_luminance_chroma(Image& image, const std::array<double, 3>& weights);

} // namespace burnish
