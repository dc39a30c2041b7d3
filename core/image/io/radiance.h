// Decodes pixels of Radiance files: both run-length codings, and plain pixels.
#pragma once
#include "core/image/io/guard.h"
#include "core/image/io/image_library.h"

namespace burnish {

// Reads a file that passed probe_radiance(), like ImageLibrary::read. Rows run along the file's first axis.
Status read_radiance(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place);

} // namespace burnish
