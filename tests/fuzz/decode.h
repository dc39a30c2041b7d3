// Decodes an image and checks the result's consistency.
#pragma once
#include "core/base/check.h"
#include "core/image/io/image_io.h"

inline void decode_and_check(const std::uint8_t* data, std::size_t size)
{
    burnish::Limits limits;
    limits.image_side = 256;
    limits.texture_bytes = 4u << 20;
    burnish::PictureNotes notes;
    const burnish::Result<burnish::Image> image = burnish::decode_colours(data, size, "fuzz", limits, notes);
    if (!image) {
        BN_CHECK(!image.error().reason.empty());
        return;
    }
    BN_CHECK(image->width > 0 && image->width <= limits.image_side && image->height > 0 && image->height <= limits.image_side);
    BN_CHECK(image->channels > 0 && image->channels <= 4);
    const std::size_t samples = static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
    BN_CHECK_OP(image->bytes.size(), ==, samples * static_cast<std::size_t>(image->channels) * burnish::pixel_type_bytes(image->type));
}
