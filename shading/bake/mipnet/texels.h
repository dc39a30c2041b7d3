// A material's normals and widths, texel by texel, as input and output of mipmap filters. tensor.h explains the channels.
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
// Returns the tensor with these widths along the direction at `angle` rad from T, and across it. widths_of() inverts this: alpha_along
// belongs to the axis at `angle` in (-pi/2, pi/2].
Tensor tensor_of(double alpha_along, double alpha_across, double angle);
struct Widths {
    double alpha_along, alpha_across, angle;
};
Widths widths_of(const Tensor& tensor); // alpha_along >= alpha_across

// Makes every texel valid for filters: normals within 78.5 degrees of +z (0.98), widths in their range. A texel with a channel that is not
// finite becomes upright, with the largest width.
void make_valid(Texels& texels);

// Applies one of a square's eight symmetries: bits 1 and 2 mirror x and y, bit 4 exchanges them, before the mirrors.
Texels mirrored(const Texels& texels, int symmetry);

// Returns a hash of the channels' bytes that is equal for all eight symmetries. Materials with equal hashes have one source.
std::uint64_t source_hash(const Texels& texels);

} // namespace burnish::mipnet
