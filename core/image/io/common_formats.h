// Decodes PNG by libpng, JPEG by libjpeg and WebP by libwebp: the pictures of most models, without the module of the image library.
#pragma once
#include <optional>

#include "core/image/io/image_library.h"

namespace burnish {

// Decodes a sound file of a common kind with the pixels that the image library gives. Returns nothing for others, and for files with a
// fault: the image library decodes those, or words the error. `place` may then have been called. An Error from `place` is returned
// unchanged.
std::optional<Status> read_png(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place);
std::optional<Status> read_jpeg(const ImageBytes& file, const PlacePixels& place); // grey and colour, 8 bits
std::optional<Status> read_webp(const ImageBytes& file, const PlacePixels& place); // without animation
// Returns a warning where another decoder than libjpeg reads this JPEG file; "" elsewhere.
std::string jpeg_warning(const ImageBytes& file);
#ifdef __EMSCRIPTEN__
std::optional<Status> read_pfm(const ImageBytes& file, const PlacePixels& place); // three channels in this byte order, scale 1
#endif

} // namespace burnish
