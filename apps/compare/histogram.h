// Distribution of FLIP errors over the pixels.
#pragma once
#include <vector>

#include "apps/report/drawing.h"
#include "core/image/image.h"
#include "core/image/metrics/metrics.h"

namespace burnish {

inline constexpr int kHistogramBins = 50; // over errors from 0 to 1

// Returns the pixels' shares by bin, [0,1]. Errors at or above 1, and NaN, count in the last bin.
std::vector<double> histogram_of(const Image& error);
Drawing plot_histogram(const Image& error, const ErrorSummary& summary);

} // namespace burnish
