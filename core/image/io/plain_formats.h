// Formats without compression, written here byte by byte.
#pragma once
#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace burnish {

// Portable Float Map (Debevec) of 1 or 3 float channels: little-endian, bottom row first.
std::vector<std::uint8_t> encode_pfm(const Image& image);

// TIFF 6.0 of 8-bit samples in one uncompressed strip, nothing but the required fields. (OpenImageIO's writer
// adds a second, Exif directory, which it cannot finish in memory.)
std::vector<std::uint8_t> encode_tiff(const Image& image);

} // namespace burnish
