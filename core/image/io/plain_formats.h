// Encoders for uncompressed formats.
#pragma once
#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace burnish {

// Encodes 1 or 3 float channels as a Portable Float Map (Debevec): little-endian, bottom row first.
std::vector<std::uint8_t> encode_pfm(const Image& image);

// Encodes 8-bit samples as TIFF 6.0, in one uncompressed strip with only the required fields. (OpenImageIO's writer
// adds a second, Exif directory, which it cannot finish in memory.)
std::vector<std::uint8_t> encode_tiff(const Image& image);

} // namespace burnish
