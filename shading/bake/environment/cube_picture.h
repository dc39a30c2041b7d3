// Converts OpenEXR cube pictures (envmap = cube) to the sky picture that environments are baked from.
#pragma once
#include <cstdint>
#include <string>

#include "core/image/image.h"
#include "core/jobs/jobs.h"

namespace burnish {

// Returns the reason why a picture is not six faces in a column, or is too large for a sky. Empty if the picture is valid.
std::string cube_picture_fault(const Image& faces, std::uint64_t most_pixels);

// Returns the sky as a linear f32 picture, 4 size x 2 size pixels, with the faces' channels. Orientation: environment.h. OpenEXR's latlong
// picture of the same surroundings reads as this picture. Each pixel is the mean of 16 directions, interpolated between texels.
Image sky_of_cube_picture(const Image& faces, const Jobs& jobs);

} // namespace burnish
