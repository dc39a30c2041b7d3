// Reads an image row as floats, without decoding: 8 and 16 bits map to [0,1].
#pragma once
#include <vector>

#include "core/image/image.h"

namespace burnish {

// Reads all channels, interleaved. Resizes `values`.
inline void read_stored_row(const Image& image, int y, std::vector<float>& values)
{
    const std::size_t n = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    const std::byte* row = image.bytes.data() + static_cast<std::size_t>(y) * n * pixel_type_bytes(image.type);
    values.resize(n);
    for (std::size_t i = 0; i < n; ++i)
        if (image.type == PixelType::u8)
            values[i] = static_cast<float>(reinterpret_cast<const std::uint8_t*>(row)[i]) / 255.0f;
        else if (image.type == PixelType::u16)
            values[i] = static_cast<float>(reinterpret_cast<const std::uint16_t*>(row)[i]) / 65535.0f;
        else
            values[i] = reinterpret_cast<const float*>(row)[i];
}

inline int colour_channels(const Image& image)
{
    return image.channels >= 3 ? 3 : 1;
}

} // namespace burnish
