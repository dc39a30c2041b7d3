// Anisotropy textures as tensors, which can be filtered, in place of directions.
#pragma once
#include "core/image/image.h"

namespace burnish {

// Converts a KHR_materials_anisotropy texture (red and green: direction in [0,1]^2, blue: strength) to an f32 image of strength^power d
// d^T per texel: channels xx, yy, xy, 0. d is the unit direction. A texel without direction (length below 1/100, or not finite) has
// strength 0. power: 2 or 4.
//
// GGX widths are alpha_t = alpha + (1 - alpha) s^2 along d and alpha across it. So twice the covariance of slopes is
//     alpha^2 I + 2 alpha (1 - alpha) s^2 d d^T + (1 - alpha)^2 s^4 d d^T,
// which is linear in both tensors. If roughness is constant under the filter, filtered tensors give the exact filtered covariance, and
// +d and -d are equal.
Image anisotropy_tensor(const Image& image, int power);

struct DirectionTensor {
    float xx = 0.0f, yy = 0.0f, xy = 0.0f;
};
DirectionTensor direction_tensor(const Image& image, std::size_t texel, int power); // of one texel

// Returns a channel as a number, for images of any type. Gray stands for all colours.
float texel_channel(const Image& image, std::size_t texel, std::size_t channel);

} // namespace burnish
