// Measures regular patterns that a technique leaves in a picture, such as combs and steps between 2x2 quads. FLIP blurs them away.
//
// The error is the difference in ln luminance, test minus reference. Only pixels inside surfaces count: alpha is 1 where there is alpha,
// luminance is above 0 in all images, and the same holds for two pixels around.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

inline constexpr double kPatternSigma = 4.0;    // for the Gaussian that the high-pass filter subtracts, pixels
inline constexpr int kPatternLags = 32;         // the autocovariance's longest lag, pixels
inline constexpr double kLongestPeriod = 16.0;  // pixels; the shortest is 2
inline constexpr int kPatternTile = 64;         // the tiles' edge, pixels; tile borders are judged
inline constexpr double kPatternFloor = 1.0e-3; // added to luminance before ln, by the reference's mean inside surfaces

struct PatternFigures {
    std::int64_t pixels = 0; // inside surfaces; 0: nothing else is known
    double rms = 0.0;        // the high-passed error's, in ln luminance (.05: 5 %)
    double period = 0.0;     // strongest period, pixels, along one axis; 0: none
    bool along_y = false;    // `period`'s axis
    double period_rms = 0.0; // the RMS for the sinusoid with this period
    // The error's mean squared step between 2x2 quads over the mean inside quads, and across tile borders over all other steps; along
    // x and y. 1: no pattern. NaN where no such steps exceed the noise.
    double quad_ratio[2] = {}, tile_ratio[2] = {};
};

// Judges `test`. Two ways take the reference's noise from every figure. Each may be null.
//   second: an independent reference. Both errors' products lack either error's noise.
//   variance: of the reference's pixel means, floats; its expected share is subtracted. Pixels must be independent; the channels of a
//             pixel deviate together, as in a path sample. `second` goes first where both are given. Where a variance is infinite, as after
//             one pass, all figures but `pixels` are NaN.
// Images have equal sizes and channel counts, and hold finite values; either all store floats (linear) or none does (sRGB).
PatternFigures pattern_figures(const Image& reference, const Image* second, const Image& test, const Jobs& jobs,
                               const Image* variance = nullptr);

// Returns f32 RGB as RGBA. alpha(i): pixel i's coverage. Patterns count only where alpha is 1.
template <class Alpha> Image with_alpha(const Image& rgb, const Alpha& alpha)
{
    Image out = make_image(rgb.width, rgb.height, 4, PixelType::f32);
    for (std::size_t i = 0; i < out.bytes.size() / (4 * sizeof(float)); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            out.f32()[4 * i + c] = rgb.f32()[3 * i + c];
        out.f32()[4 * i + 3] = alpha(i);
    }
    return out;
}

} // namespace burnish
