// Maps equirectangular images to a cube. Every texel is the integral of the image over its footprint.
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

// Upper limit of light (the sun has 1.6e9 cd/m^2). Larger values count as infinite.
inline constexpr float kMostRadiance = 1e12f;

// Converts an image to linear radiance. Reads 8- and 16-bit images as sRGB. NaN becomes 0, infinite values become the image's largest
// finite value. Negative values become 0 and darken their surroundings, so that each channel's total light, by solid angle, stays the
// same.
Equirect make_equirect(const Image& image);

// Returns one line for each kind of repair or guess that make_equirect() makes for this image.
std::vector<std::string> equirect_warnings(const Image& image);

// Returns a warning if the picture is not twice as wide as high: it is stretched over the sphere. The warning names the cube layout that
// the picture looks like. Empty for a 2:1 picture, and if all pixels are equal.
std::string equirect_shape_warning(const Image& image);

double mean_luminance(const Equirect& source); // over the sphere: pixels weighted by solid angle
float peak_value(const Equirect& source);      // largest channel value

// All directions within `radius` of `centre`.
struct SkyCap {
    Direction centre; // unit
    double radius;    // radians
};

// Samples the source on a cube with at least `size` texels along an edge, a power of two. The cube is no coarser than the source, up to a
// limit.
CubeLevel sample_equirect(const Equirect& source, int size, const Jobs& jobs);
// Updates the cube after the source has changed within the caps only. Gives sample_equirect()'s bits in a fraction of its time.
void sample_equirect_again(CubeLevel& sampled, const Equirect& source, const std::vector<SkyCap>& changed, const Jobs& jobs);
// Averages a cube down to `size` texels along an edge. Light is preserved.
CubeLevel averaged_to(const CubeLevel& sampled, int size, const Jobs& jobs);

CubeLevel equirect_to_cube(const Equirect& source, int size, const Jobs& jobs); // samples, then averages

} // namespace burnish
