// Equirectangular images onto a cube: every texel is the integral of the image over its footprint.
#pragma once
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "shading/bake/environment/cube_map.h"

namespace burnish {

// Linear RGB radiance, finite and not negative.
struct Equirect {
    int width = 0, height = 0;
    std::vector<float> rgb;
};

// No light is brighter (the sun has 1.6e9 cd/m^2): above it, values are taken for infinite ones.
inline constexpr float kMostRadiance = 1e12f;

// 8- and 16-bit images are taken as sRGB. NaN becomes 0, infinite values the largest finite value of the image. Negative values become 0,
// and what is around them darker by as much, so that the light of each channel, by solid angle, stays as it is.
Equirect make_equirect(const Image& image);

// One line for each kind of what make_equirect() repairs or has to guess in this image.
std::vector<std::string> equirect_warnings(const Image& image);

double mean_luminance(const Equirect& source); // over the sphere: pixels weighted by their solid angles
float peak_value(const Equirect& source);      // largest channel value

CubeLevel equirect_to_cube(const Equirect& source, int size, const Jobs& jobs);

} // namespace burnish
