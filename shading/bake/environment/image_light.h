// A cube of images around a scene as the picture of the sky that environments are baked from.
#pragma once
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/scene/image_light.h"

namespace burnish {

// Linear f32 RGB radiance, 4 size x 2 size pixels, oriented as environment.h has it. Each is the mean of what the cube, constant on its
// texels, shows in 16 directions; a divisor of 0 is black.
Image sky_of(const ImageLight& light, const Jobs& jobs);

} // namespace burnish
