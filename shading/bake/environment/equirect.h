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

// Says that a picture, not twice as wide as high, is stretched over the whole sphere, and which layout of a cube it looks like. Empty where
// it is, and where all pixels are equal.
std::string equirect_shape_warning(const Image& image);

double mean_luminance(const Equirect& source); // over the sphere: pixels weighted by their solid angles
float peak_value(const Equirect& source);      // largest channel value

// Directions within an angle of one.
struct SkyCap {
    Direction centre; // unit
    double radius;    // radians
};

// The source on a cube of at least `size` texels along an edge, a power of two, that is no coarser than the source.
CubeLevel sample_equirect(const Equirect& source, int size, const Jobs& jobs);
// The same again where the source has changed within caps and nowhere else: with all of sample_equirect()'s bits, and little of its time.
void sample_equirect_again(CubeLevel& sampled, const Equirect& source, const std::vector<SkyCap>& changed, const Jobs& jobs);
// Averaged down to `size` texels along an edge: sums of texels lose nothing.
CubeLevel averaged_to(const CubeLevel& sampled, int size, const Jobs& jobs);

CubeLevel equirect_to_cube(const Equirect& source, int size, const Jobs& jobs); // both

} // namespace burnish
