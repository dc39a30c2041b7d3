// How much of a measured error may be the reference's own noise.
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"

namespace burnish {

// A picture plus Gaussian noise of its variance: `mean` and `variance` (of the mean, not negative) are f32 RGB of one size. Pixels are
// independent of each other; the channels of one deviate together, as those of a sample do. A function of its arguments alone.
Image with_noise(const Image& mean, const Image& variance, std::uint32_t seed, const Jobs& jobs);

// Mean HDR-FLIP between a reference and itself with as much noise again as it holds: of the size of what noise adds to the mean FLIP of a
// picture without error. NaN where a variance is infinite, as that of a single pass is.
double noise_flip(const Image& mean, const Image& variance, Isa isa, const Jobs& jobs);

} // namespace burnish
