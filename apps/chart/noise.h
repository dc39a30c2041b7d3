// Bounds the part of a measured error that may be the reference's own noise.
#pragma once
#include <cstdint>

#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"

namespace burnish {

// Adds Gaussian noise with the given variance to a picture. `mean` and `variance` (of the mean, not negative) are f32 RGB of one size.
// Pixels are independent; the channels of a pixel deviate together, as in a path sample. The result depends on the arguments alone.
Image with_noise(const Image& mean, const Image& variance, std::uint32_t seed, const Jobs& jobs);

// Returns the mean HDR-FLIP between a reference and the reference plus as much noise again. Noise adds about as much to the FLIP of a
// picture without error. NaN if a variance is infinite, as after a single pass.
double noise_flip(const Image& mean, const Image& variance, Isa isa, const Jobs& jobs);

} // namespace burnish
