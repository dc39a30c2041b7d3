// What the environment light of an Ashikhmin-Shirley lobe is made of, as pictures: half vectors, and directional albedo.
#pragma once
#include "apps/cli/values.h"
#include "core/image/image.h"
#include "shading/bake/tables/phong.h"

namespace burnish {

// Texel (x, y) of width x height is the half vector of (x / width, y / height), so the first is the normal; in the lobe's frame, nu along
// the first axis. Floats hold x, y, z and the density of half vectors, 1/sr; 8 bits x, y, z from -1 to 1: code 128 is 0, 255 is 1.
Image half_vector_table(double nu, double nv, const PictureSize& size, PixelType type);

// How many different values a picture's first channel has: what is left of the direction across the lobe.
int codes_of(const Image& image);

// Directional albedo without absorption as f0 red + green, floats: of an eye whose cosine is (y / (height - 1))^2, at an azimuth whose
// cosine off the lobe's wide axis is (x / (width - 1))^2, or by AzimuthAxis::linear at (pi / 2) x / (width - 1) from the axis of nu.
Image albedo_table(double nu, double nv, const PictureSize& size, AzimuthAxis azimuth);

} // namespace burnish
