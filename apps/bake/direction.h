// Maps of the grain's direction made of pictures.
#pragma once
#include "core/image/image.h"

namespace burnish {

enum class DirectionFrom { hue, luminance };

// An anisotropy texture (KHR_materials_anisotropy, 8 bits): what `from` says of a pixel, once around, is an angle from 0 to pi from the
// tangent, counter-clockwise, red and green its direction; blue: strength, [0, 1]. Grey pixels have hue 0. Pictures of floats are linear,
// others sRGB; luminance is what the eye takes for even steps, the sRGB value of grey that is as bright.
Image direction_map(const Image& picture, DirectionFrom from, double strength);

} // namespace burnish
