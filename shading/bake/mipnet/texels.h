// A material's normals and widths, texel by texel, as mipmaps of them are made: see tensor.h for what the channels mean.
#pragma once
#include <cstdint>
#include <vector>

#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish::mipnet {

inline constexpr double kLeastAlpha = 0.002;

struct Texels {
    int width = 0, height = 0;
    std::vector<float> channel[kChannels]; // nx, ny, a, b, c; rows from the top
    std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};
Texels make_texels(int width, int height);

struct Tensor {
    double a, b, c;
};
// Of widths along the direction at `angle` rad from T, and across it; and back: alpha_along is that of the axis at `angle` in (-pi/2,
// pi/2].
Tensor tensor_of(double alpha_along, double alpha_across, double angle);
struct Widths {
    double alpha_along, alpha_across, angle;
};
Widths widths_of(const Tensor& tensor); // alpha_along >= alpha_across

// What every texel has to be before anything is made of it: normals within 78.5 degrees of +z (0.98), widths in their range. A texel with a
// channel that is not finite becomes level and as wide as can be.
void make_valid(Texels& texels);

// One of the eight symmetries of a square: bits 1 and 2 mirror x and y, bit 4 exchanges them, first of all.
Texels mirrored(const Texels& texels, int symmetry);

// Of the channels' bytes, the same for all eight: two materials with one hash are one source.
std::uint64_t source_hash(const Texels& texels);

} // namespace burnish::mipnet
