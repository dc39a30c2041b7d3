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

// Fills the verdict, the reason and the figures. `shown`: beginning of file names; writes SHOWN.png, SHOWN%golden.png and SHOWN%error.png
// for the page where values differ, the error by colours.
void judge(const GoldenLimits& limits, DifferenceInput input, const Jobs& jobs, const std::string& shown, GoldenResult& result);

// Writes a picture as 8-bit PNG for the page: floats exposed and tonemapped.
Status show(const Image& image, float exposure_ev, const std::string& path);

} // namespace burnish
