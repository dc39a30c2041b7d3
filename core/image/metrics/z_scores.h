// Tests whether two noisy images can estimate the same image: a z-test for each pixel and colour channel. The level of
// a single test gives all tests together the requested probability of an error (Sidak 1967, "Rectangular Confidence
// Regions for the Means of Multivariate Normal Distributions").
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct ZTest {
    double limit = 0.0;        // a larger |z| rejects a channel
    double largest = 0.0;      // largest |z|; infinite where images differ without any variance
    std::int64_t rejected = 0; // pixels with a rejected colour channel
    double rejected_fraction = 0.0;
};

// Tests all pixels. The variances belong to the compared estimates (pixel means), not to single samples.
// `test_variance` may be null for a test image without noise. All images have equal sizes and channel counts, and hold
// finite floats; variances are not negative. significance is in (0,1).
ZTest z_test(const Image& reference, const Image& test, const Image& reference_variance, const Image* test_variance, double significance,
             const Jobs& jobs);

// Returns the two-sided limit of one normal test among `tests` that together have the given significance.
double sidak_limit(double significance, std::int64_t tests);

} // namespace burnish
