// Errors of a test image against its reference. Sums are in double, row by row in order, so that every figure has equal
// bits for every thread count.
//
// Compares values as stored: 8 and 16 bits as display values in [0,1], floats as linear values. mse, rel_mse, psnr and
// ssim use the colours; max_abs and differing_fraction use alpha too.
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

// Keeps dark pixels from dominating rel_mse: the constant of Rousselle, Knaus, Zwicker 2011, "Adaptive Sampling and
// Reconstruction using Greedy Error Minimization", section 6.
inline constexpr double kRelativeMseEpsilon = 0.01;

struct PixelFigures {
    double mse = 0.0;                // mean of (reference - test)^2 over pixels and channels
    double rel_mse = 0.0;            // mean of (reference - test)^2 / (reference^2 + kRelativeMseEpsilon)
    double psnr = 0.0;               // 10 log10(peak^2 / mse), dB; infinite where mse is 0
    double max_abs = 0.0;            // largest |reference - test| in any channel
    double differing_fraction = 0.0; // share of pixels that differ in any channel
};

// Functions of two images expect equal sizes and channel counts; either both images store floats, or neither does. They throw CheckFailed
// otherwise, and Stopped where the calling thread's work is to stop (core/jobs/control.h).
PixelFigures pixel_figures(const Image& reference, const Image& test, const Jobs& jobs);

// Returns the structural similarity, 1 for equal images: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality
// Assessment: From Error Visibility to Structural Similarity". Uses its Gaussian window of 11 x 11 (sigma 1.5), K1 =
// 0.01, K2 = 0.03, on the stored values' luminance 0.2126 R + 0.7152 G + 0.0722 B. Averages over all windows inside the
// image; across a side shorter than the window, edge pixels repeat.
double ssim(const Image& reference, const Image& test, const Jobs& jobs);

// Counts pixels where a channel in either image is NaN or Inf.
std::int64_t not_finite_pixels(const Image& reference, const Image& test);

// Returns the dynamic range for psnr and ssim: 1 for display values. For floats, the reference's largest colour value,
// or 1 where this value is not positive.
double peak_value(const Image& reference);

// Summary of an error map: one float channel in [0,1].
struct ErrorSummary {
    double mean = 0.0;
    double p99 = 0.0;             // the smallest error that at least 99 % of the pixels do not exceed
    double weighted_median = 0.0; // half the sum of all errors comes from larger errors (as in FLIP's tool)
    double max = 0.0;
};
ErrorSummary summarise_errors(const Image& error);

} // namespace burnish
