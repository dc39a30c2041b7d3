// Whether two noisy pictures can be estimates of the same one: a z-test of every pixel and colour channel,
// with the level of a single test chosen so that all of them together are wrong with the given probability
// only (Sidak 1967, "Rectangular Confidence Regions for the Means of Multivariate Normal Distributions").
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct ZTest {
    double limit = 0.0;        // |z| beyond which a channel is rejected
    double largest = 0.0;      // |z|; infinite where pictures differ though nothing varies
    std::int64_t rejected = 0; // pixels of which any colour channel is rejected
    double rejected_fraction = 0.0;
};

// The variances are those of the pixels' means, that is of the estimates compared, not of single samples; the
// test's may be null where it has no noise of its own. All pictures are of one size and as many channels,
// floats, finite, variances not negative. significance in (0,1).
ZTest z_test(const Image& reference, const Image& test, const Image& reference_variance, const Image* test_variance, double significance,
             const Jobs& jobs);

// The two-sided limit of one of `tests` normal tests that together have the given significance.
double sidak_limit(double significance, std::int64_t tests);

} // namespace burnish
