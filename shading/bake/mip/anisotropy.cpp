#include "shading/bake/mip/anisotropy.h"

#include <cmath>

#include "core/base/check.h"

namespace burnish {

float texel_channel(const Image& image, std::size_t texel, std::size_t channel)
{
    const std::size_t channels = static_cast<std::size_t>(image.channels);
    const std::size_t index = texel * channels + (channels >= 3 ? channel : 0);
    switch (image.type) {
    case PixelType::u8:
        return static_cast<float>(reinterpret_cast<const std::uint8_t*>(image.bytes.data())[index]) / 255.0f;
    case PixelType::u16:
        return static_cast<float>(reinterpret_cast<const std::uint16_t*>(image.bytes.data())[index]) / 65535.0f;
    default:
        return image.f32()[index];
    }
}

DirectionTensor direction_tensor(const Image& image, std::size_t texel, int power)
{
    const float r = texel_channel(image, texel, 0), g = texel_channel(image, texel, 1), b = texel_channel(image, texel, 2);
    const float x = 2.0f * r - 1.0f, y = 2.0f * g - 1.0f, length2 = x * x + y * y;
    if (!(length2 >= 1e-4f && std::isfinite(length2) && std::isfinite(b))) // float images may hold NaN
        return {};
    const float s2 = b * b, weight = (power == 2 ? s2 : s2 * s2) / length2;
    const auto finite = [](float value) { return std::isfinite(value) ? value : 0.0f; };
    return {finite(weight * x * x), finite(weight * y * y), finite(weight * x * y)};
}

Image anisotropy_tensor(const Image& image, int power)
{
    BN_CHECK(power == 2 || power == 4);
    Image out = make_image(image.width, image.height, 4, PixelType::f32);
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < pixels; ++i) {
        const DirectionTensor t = direction_tensor(image, i, power);
        float* to = out.f32() + 4 * i;
        to[0] = t.xx, to[1] = t.yy, to[2] = t.xy, to[3] = 0.0f;
    }
    return out;
}

} // namespace burnish
