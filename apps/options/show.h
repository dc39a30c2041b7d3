// --show: surface properties in false colour, in place of the reflected light.
#pragma once
#include <string>

#include "core/image/image.h"
#include "raster/frame/frame.h"

namespace burnish {

enum class Shown { light, lod, tensor, normal };

// Returns u8 RGB of the layers at pixel centres; black where no surface is seen.
//   lod     mip level of the normal map, else of the first texture: one colour a level, interpolated; gray without a texture
//   tensor  projected lobe: red and green are square roots of alpha to the right and upwards, blue is the correlation of both
//           (128: axis along one of them, above 128: axis points up and right)
//   normal  the lobe's normal in world space, mapped from [-1,1] to [0,1]
Image false_colour(Shown what, const Frame& frame, const View& view);

} // namespace burnish
