// How FLIP's errors are spread over the pixels.
#pragma once
#include <vector>

#include "apps/report/drawing.h"
#include "core/image/image.h"
#include "core/image/metrics/metrics.h"

namespace burnish {

inline constexpr int kHistogramBins = 50; // of errors from 0 to 1

std::vector<double> histogram_of(const Image& error); // part of the pixels by bin, [0, 1]; what is not below 1 is in the last one
Drawing plot_histogram(const Image& error, const ErrorSummary& summary);

} // namespace burnish
