#include "apps/bake/direction.h"

#include <algorithm>
#include <cmath>

#include "core/image/colour.h"
#include "core/math/scalar_math.h"

namespace burnish {
namespace {

struct Colour { // sRGB, [0,1]
    double r, g, b;
};

Colour colour_at(const Image& image, std::size_t pixel)
{
    const std::size_t channels = static_cast<std::size_t>(image.channels), at = pixel * channels;
    const auto value = [&](std::size_t channel) {
        const std::size_t i = at + (channels < 3 ? 0 : channel);
        if (image.type == PixelType::u8)
            return static_cast<double>(image.bytes[i]) / 255.0;
        if (image.type == PixelType::u16)
            return static_cast<double>(reinterpret_cast<const std::uint16_t*>(image.bytes.data())[i]) / 65535.0;
        const float linear = image.f32()[i];
        return static_cast<double>(linear_to_srgb(std::clamp(std::isfinite(linear) ? linear : 0.0f, 0.0f, 1.0f)));
    };
    return {value(0), value(1), value(2)};
}

double hue(const Colour& c) // [0,1), once around
{
    const double most = std::max({c.r, c.g, c.b}), range = most - std::min({c.r, c.g, c.b});
    if (range <= 0.0)
        return 0.0;
    const double sixth = most == c.r ? (c.g - c.b) / range : most == c.g ? 2.0 + (c.b - c.r) / range : 4.0 + (c.r - c.g) / range;
    return sixth < 0.0 ? sixth / 6.0 + 1.0 : sixth / 6.0;
}

double luminance(const Colour& c)
{
    const auto linear = [](double v) { return static_cast<double>(srgb_to_linear(static_cast<float>(v))); };
    const double y = 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
    return static_cast<double>(linear_to_srgb(static_cast<float>(std::clamp(y, 0.0, 1.0))));
}

std::byte byte_of(double value)
{
    return static_cast<std::byte>(static_cast<int>(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5));
}

} // namespace

Image direction_map(const Image& picture, DirectionFrom from, Strokes strokes, double strength)
{
    Image map = make_image(picture.width, picture.height, 3, PixelType::u8);
    const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    for (std::size_t i = 0; i < pixels; ++i) {
        const Colour c = colour_at(picture, i);
        const double stroke = kPi * (from == DirectionFrom::hue ? hue(c) : luminance(c));
        const double angle = strokes == Strokes::grooves ? stroke + 0.5 * kPi : stroke;
        map.bytes[3 * i] = byte_of(0.5 + 0.5 * det_cos(angle));
        map.bytes[3 * i + 1] = byte_of(0.5 + 0.5 * det_sin(angle));
        map.bytes[3 * i + 2] = byte_of(strength);
    }
    return map;
}

} // namespace burnish
