// The difference of a picture and its golden, in figures and in words.
#pragma once
#include <optional>
#include <string>

#include "apps/golden/check.h"
#include "core/image/image.h"

namespace burnish {

struct DifferenceInput {
    Image golden, picture;
    std::optional<Image> mask; // black pixels do not count
    std::optional<Image> golden_variance, variance;
};

inline constexpr int kMoreExposures[] = {-4, -2, 2, 4}; // stops from the exposure of the page's pictures

// Returns the end of a shown picture's name: "%ev-4.png", and ".png" for 0 stops.
std::string exposure_ending(int stops);

// Fills the verdict, the reason and the figures. `shown`: beginning of file names; writes SHOWN.png, SHOWN%golden.png and SHOWN%error.png
// for the page where values differ, the error by colours. Linear pictures that fail get SHOWN and SHOWN%golden at more exposures.
void judge(const GoldenLimits& limits, DifferenceInput input, const Jobs& jobs, const std::string& shown, GoldenResult& result);

// Writes a picture as 8-bit PNG for the page: floats exposed and tonemapped.
Status show(const Image& image, float exposure_ev, const std::string& path);

} // namespace burnish
