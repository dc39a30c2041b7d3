#include "core/scene/mtlx/channels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/image/colour.h"

namespace burnish::mtlx {

float value_at(const Image& image, std::size_t at)
{
    if (image.type == PixelType::f32)
        return image.f32()[at];
    if (image.type == PixelType::u8)
        return static_cast<float>(std::to_integer<int>(image.bytes[at])) / 255.0f;
    std::uint16_t code;
    std::memcpy(&code, image.bytes.data() + 2 * at, sizeof code);
    return static_cast<float>(code) / 65535.0f;
}

namespace {

// Returns the index of a channel in an image: gray has one channel for all colours, and alpha is the last of two or four. -1: none.
int channel_in(const Image& image, int channel)
{
    const bool gray = image.channels < 3, has_alpha = image.channels == 2 || image.channels == 4;
    if (channel == 3)
        return has_alpha ? image.channels - 1 : -1;
    return gray ? 0 : channel;
}

} // namespace

Image channel_of(const Image& image, const PictureInput& picture, float most)
{
    const int from = channel_in(image, picture.channel);
    const float factor = picture.factor[0];
    const bool decoded = picture.encoded && picture.channel < 3,
               same = from >= 0 && factor == 1.0f && !decoded && image.type != PixelType::f32;
    const std::size_t each = static_cast<std::size_t>(image.channels), size = pixel_type_bytes(image.type);
    Image r = make_image(image.width, image.height, 1, same ? image.type : PixelType::f32);
    const std::size_t count = static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = i * each + static_cast<std::size_t>(std::max(from, 0));
        if (same) {
            std::memcpy(r.bytes.data() + i * size, image.bytes.data() + at * size, size);
            continue;
        }
        const float value = from < 0 ? 1.0f : value_at(image, at);
        r.f32()[i] = std::clamp((decoded ? srgb_to_linear(std::clamp(value, 0.0f, 1.0f)) : value) * factor, 0.0f, most);
    }
    return r;
}

Image colours_of(const Image& image, const PictureInput& picture, bool with_alpha)
{
    const bool has_alpha = image.channels == 2 || image.channels == 4, as_it_is = picture.encoded != (image.type == PixelType::f32);
    if (as_it_is && (!has_alpha || with_alpha))
        return image;
    const std::size_t each = static_cast<std::size_t>(image.channels), colours = image.channels < 3 ? 1 : 3,
                      kept = colours + (has_alpha && with_alpha ? 1 : 0);
    const std::size_t size = pixel_type_bytes(image.type);
    Image r = make_image(image.width, image.height, static_cast<int>(kept), as_it_is ? image.type : PixelType::f32);
    const std::size_t count = static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < kept; ++c) {
            const std::size_t at = i * each + (c < colours ? c : each - 1), to = i * kept + c;
            if (as_it_is) {
                std::memcpy(r.bytes.data() + to * size, image.bytes.data() + at * size, size);
                continue;
            }
            const float value = value_at(image, at);
            r.f32()[to] = picture.encoded && c < colours ? srgb_to_linear(std::clamp(value, 0.0f, 1.0f)) : value;
        }
    return r;
}

} // namespace burnish::mtlx
