// Figures of how far a test picture is from its reference. Sums are taken in double, row by row in order, so
// every figure is the same bits for every number of threads.
//
// Values are compared as they are stored: 8 and 16 bits as display values in [0,1], floats as linear values.
// mse, rel_mse, psnr and ssim look at colours, max_abs and differing_fraction at alpha too.
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

// Keeps dark pixels from deciding rel_mse alone: the constant of Rousselle, Knaus, Zwicker 2011, "Adaptive
// Sampling and Reconstruction using Greedy Error Minimization", section 6.
inline constexpr double kRelativeMseEpsilon = 0.01;

struct PixelFigures {
    double mse = 0.0;                // mean of (reference - test)^2 over pixels and channels
    double rel_mse = 0.0;            // mean of (reference - test)^2 / (reference^2 + kRelativeMseEpsilon)
    double psnr = 0.0;               // 10 log10(peak^2 / mse), dB; infinite where mse is 0
    double max_abs = 0.0;            // largest |reference - test| of any channel
    double differing_fraction = 0.0; // part of the pixels of which any channel differs at all
};

// All functions of two pictures want them of one size and as many channels; both stored as floats, or
// neither.
PixelFigures pixel_figures(const Image& reference, const Image& test, const Jobs& jobs);

// Structural similarity, 1 for equal pictures: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality
// Assessment: From Error Visibility to Structural Similarity", with its Gaussian window of 11 x 11
// (sigma 1.5), K1 = 0.01, K2 = 0.03. The mean over all windows that lie inside the picture; across a side
// shorter than the window, edge pixels repeat. Of the luminance 0.2126 R + 0.7152 G + 0.0722 B of the stored
// values.
double ssim(const Image& reference, const Image& test, const Jobs& jobs);

// Pixels of which any channel of either picture is NaN or Inf.
std::int64_t not_finite_pixels(const Image& reference, const Image& test);

// The dynamic range that psnr and ssim refer to: 1 for display values; for floats the reference's largest
// colour value, 1 where that is not positive.
double peak_value(const Image& reference);

// A map of errors in [0,1], one float channel, in four figures.
struct ErrorSummary {
    double mean = 0.0;
    double p99 = 0.0;             // the smallest error that at least 99 % of the pixels do not exceed
    double weighted_median = 0.0; // the error above which lies half of the sum of all errors (as FLIP's tool prints it)
    double max = 0.0;
};
ErrorSummary summarise_errors(const Image& error);

} // namespace burnish
