// Pixels of Radiance files, decoded here: both codings of runs, and plain pixels.
#pragma once
#include "core/image/io/guard.h"
#include "core/image/io/image_library.h"

namespace burnish {

// The function of an ImageLibrary for files that probe_radiance() has let through. Scanlines come as the file has them, its first axis as
// rows.
Status read_radiance(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place);

} // namespace burnish
