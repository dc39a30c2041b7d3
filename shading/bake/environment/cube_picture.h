// OpenEXR's pictures of cubes (envmap = cube) as the picture of the sky that environments are baked from.
#pragma once
#include <cstdint>
#include <string>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

// Why a picture is no cube of six faces, one below the other, or too large a sky. Empty where it is one.
std::string cube_picture_fault(const Image& faces, std::uint64_t most_pixels);

// Linear f32 picture of the sky, 4 size x 2 size pixels of the faces' channels, oriented as environment.h has it: what OpenEXR's latlong
// picture of the same surroundings is read as. Each pixel is the mean of 16 directions, interpolated between texels.
Image sky_of_cube_picture(const Image& faces, const Jobs& jobs);

} // namespace burnish
