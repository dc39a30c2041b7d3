// Lookup tables for the environment light of Ashikhmin-Shirley lobes, as pictures: half vectors and directional albedo.
#pragma once
#include "apps/cli/values.h"
#include "core/image/image.h"
#include "shading/bake/tables/phong.h"

namespace burnish {

// Returns half vectors in the lobe's frame, nu along the first axis. Texel (x, y) holds the half vector for the random numbers (x /
// width, y / height), so the first texel is the normal. Float texels hold x, y, z and the density of half vectors, 1/sr. 8-bit texels
// hold x, y, z from -1 to 1: code 128 is 0, 255 is 1.
Image half_vector_table(double nu, double nv, const PictureSize& size, PixelType type);

// Returns the number of different values in a picture's first channel: the remaining resolution across the lobe.
int codes_of(const Image& image);

// Returns directional albedo without absorption as f0 red + green, in floats. Row y has n_dot_v = (y / (height - 1))^2. Column x has the
// view azimuth with cosine (x / (width - 1))^2 from the lobe's wide axis, or (pi / 2) x / (width - 1) from the axis of nu with
// AzimuthAxis::linear.
Image albedo_table(double nu, double nv, const PictureSize& size, AzimuthAxis azimuth);

} // namespace burnish
