// Converts a cube of images around a scene to the sky picture that environments are baked from.
#pragma once
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/scene/image_light.h"

namespace burnish {

// Returns linear f32 RGB radiance, 4 size x 2 size pixels. Orientation: environment.h. Each pixel is the mean of the cube in 16
// directions; the cube is constant on its texels. A divisor of 0 is black.
Image sky_of(const ImageLight& light, const Jobs& jobs);

} // namespace burnish
