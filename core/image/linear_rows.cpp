#include "core/image/linear_rows.h"

#include <algorithm>

#include "core/image/colour.h"

namespace burnish {

LinearRows::LinearRows(const Image& image) : image_(image)
{
    if (image.type == PixelType::f32)
        return;
    const std::size_t codes = image.type == PixelType::u8 ? 256 : 65536;
    decode_.resize(codes);
    for (std::size_t code = 0; code < codes; ++code)
        decode_[code] = srgb_to_linear(static_cast<float>(code) / static_cast<float>(codes - 1));
}

template <class T> void LinearRows::read_as(int y, int x, int n, float* r, float* g, float* b) const
{
    const int channels = image_.channels;
    const T* row = reinterpret_cast<const T*>(image_.bytes.data()) +
                   static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) *
                       static_cast<std::size_t>(channels);
    const auto value = [this](T code) {
        if constexpr (sizeof(T) == sizeof(float))
            return code;
        else
            return decode_[code];
    };
    const int to_g = channels >= 3 ? 1 : 0, to_b = channels >= 3 ? 2 : 0;
    const int begin = std::clamp(-x, 0, n - 1),
              end = std::clamp(image_.width - x, begin + 1, n); // inside the picture
    const T* from = row + static_cast<std::size_t>(x + begin) * static_cast<std::size_t>(channels);
    for (int i = begin; i < end; ++i, from += channels) {
        r[i] = value(from[0]);
        g[i] = value(from[to_g]);
        b[i] = value(from[to_b]);
    }
    for (float* plane : {r, g, b}) {
        std::fill(plane, plane + begin, plane[begin]);
        std::fill(plane + end, plane + n, plane[end - 1]);
    }
}

void LinearRows::read(int y, int x, int n, float* r, float* g, float* b) const
{
    if (image_.type == PixelType::u8)
        read_as<std::uint8_t>(y, x, n, r, g, b);
    else if (image_.type == PixelType::u16)
        read_as<std::uint16_t>(y, x, n, r, g, b);
    else
        read_as<float>(y, x, n, r, g, b);
}

std::vector<float> LinearRows::luminances() const
{
    const std::size_t width = static_cast<std::size_t>(image_.width);
    std::vector<float> all, r(width), g(width), b(width);
    all.reserve(width * static_cast<std::size_t>(image_.height));
    for (int y = 0; y < image_.height; ++y) {
        read(y, 0, image_.width, r.data(), g.data(), b.data());
        for (std::size_t x = 0; x < width; ++x)
            all.push_back(0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x]);
    }
    return all;
}

} // namespace burnish
