#include "apps/compare/displayed.h"

#include <fmt/core.h>

#include "core/image/colour.h"

namespace burnish {

Image displayed(const Image& image, float exposure_ev)
{
    if (image.type == PixelType::f32)
        return tonemap_to_srgb8(image, Tonemap::pbr_neutral, exposure_ev);
    if (image.type == PixelType::u8)
        return image;
    Image out = make_image(image.width, image.height, image.channels, PixelType::u8);
    const std::uint16_t* from = reinterpret_cast<const std::uint16_t*>(image.bytes.data());
    for (std::size_t i = 0; i < out.bytes.size(); ++i)
        out.bytes[i] = static_cast<std::byte>((from[i] + 128u) / 257u);
    return out;
}

std::string describe(const Image& image)
{
    const char* type = image.type == PixelType::u8 ? "8 bits" : image.type == PixelType::u16 ? "16 bits" : "floats";
    return fmt::format("{}x{}, {} channel{}, {}", image.width, image.height, image.channels, image.channels == 1 ? "" : "s", type);
}

} // namespace burnish
