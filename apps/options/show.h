// --show: what a surface is, in false colour, in place of the light that it reflects.
#pragma once
#include <string>

#include "core/image/image.h"
#include "raster/frame/frame.h"

namespace burnish {

enum class Shown { light, lod, tensor, normal };

// u8 RGB, as the frame's layers have it at each pixel's centre; black where nothing is seen.
//   lod     the level that the normal map, else the first texture, is read at: a colour a level, mixed between two; gray without a texture
//   tensor  the lobe as it lies in the picture: red and green are roots of its widths alpha to the right and upwards, blue how its axis
//   lies
//           between them (128: along one, above: up to the right)
//   normal  the lobe's normal, world space: half of x, y and z above a half
Image false_colour(Shown what, const Frame& frame, const View& view);

} // namespace burnish
