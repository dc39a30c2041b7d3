// Anisotropy textures as something that can be filtered: tensors instead of directions.
#pragma once
#include "core/image/image.h"

namespace burnish {

// KHR_materials_anisotropy texture (red and green: direction in [0,1]^2, blue: strength) to an f32 image of
// strength^power d d^T by texel: channels xx, yy, xy, 0. d is the unit direction; a texel without one (length
// below 1/100, or not finite) has strength 0. power: 2 or 4.
//
// Why: GGX widths are alpha_t = alpha + (1 - alpha) s^2 along d and alpha across it, so twice the covariance
// of slopes is
//     alpha^2 I + 2 alpha (1 - alpha) s^2 d d^T + (1 - alpha)^2 s^4 d d^T,
// linear in both tensors: where roughness is constant under the filter, whatever it is, filtering them filters
// the covariance exactly, and +d and -d are the same.
Image anisotropy_tensor(const Image& image, int power);

// Of an image of any type, as a number; gray stands for all colours.
float texel_channel(const Image& image, std::size_t texel, std::size_t channel);

} // namespace burnish
