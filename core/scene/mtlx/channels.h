// Values that a MaterialX input takes from a picture.
#pragma once
#include <cstddef>

#include "core/image/image.h"
#include "core/scene/mtlx/document.h"

namespace burnish::mtlx {

// Returns a stored value: codes of 8 and 16 bits as [0,1]. at: counts values, channels included.
float value_at(const Image& image, std::size_t at);

// Returns the channel that an input takes, times its factor, clamped between 0 and `most`. Encoded colours become linear, an alpha that is
// not there 1. Floats where the values differ from the file's.
Image channel_of(const Image& image, const PictureInput& picture, float most);

// Returns the picture's colours as the slot of base colours takes them: 8 and 16 bits encoded, floats linear. with_alpha: keeps alpha.
Image colours_of(const Image& image, const PictureInput& picture, bool with_alpha);

} // namespace burnish::mtlx
