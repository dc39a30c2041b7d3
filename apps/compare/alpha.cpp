#include "apps/compare/alpha.h"

#include <cstdint>
#include <cstring>
#include <fmt/core.h>

namespace burnish {
namespace {

// Returns how many values of the last channel are not 1. NaN is none.
template <class T> std::size_t not_one(const Image& image, T one)
{
    const std::size_t texel = static_cast<std::size_t>(image.channels) * sizeof(T);
    std::size_t count = 0;
    for (std::size_t end = texel; end <= image.bytes.size(); end += texel) {
        T value;
        std::memcpy(&value, image.bytes.data() + end - sizeof(T), sizeof(T));
        count += !(value == one);
    }
    return count;
}

std::size_t not_opaque_pixels(const Image& image)
{
    switch (image.type) {
    case PixelType::u8:
        return not_one<std::uint8_t>(image, 255);
    case PixelType::u16:
        return not_one<std::uint16_t>(image, 65535);
    case PixelType::f32:
        break;
    }
    return not_one<float>(image, 1.0f);
}

void drop_last_channel(Image& image)
{
    const std::size_t texel = static_cast<std::size_t>(image.channels) * pixel_type_bytes(image.type);
    const std::size_t kept = texel - pixel_type_bytes(image.type);
    const std::size_t pixels = image.bytes.size() / texel;
    for (std::size_t p = 1; p < pixels; ++p)
        std::memmove(image.bytes.data() + p * kept, image.bytes.data() + p * texel, kept);
    image.bytes.resize(pixels * kept);
    --image.channels;
}

} // namespace

Result<std::string> drop_lone_alpha(Image& reference, const std::string& reference_name, Image& test, const std::string& test_name)
{
    const bool of_reference = reference.channels > test.channels;
    Image& with = of_reference ? reference : test;
    const Image& without = of_reference ? test : reference;
    const bool alike =
        with.width == without.width && with.height == without.height && (with.type == PixelType::f32) == (without.type == PixelType::f32);
    if (!alike || with.channels != without.channels + 1 || (with.channels != 2 && with.channels != 4))
        return std::string();
    const std::string &name = of_reference ? reference_name : test_name, &other = of_reference ? test_name : reference_name;
    if (const std::size_t count = not_opaque_pixels(with))
        return Error{
            ExitCode::size_mismatch, name, "",
            fmt::format("alpha is not 1 in {} of {} pixels, and {} has no alpha", count, std::int64_t{with.width} * with.height, other)};
    drop_last_channel(with);
    return fmt::format("{} alone has alpha, 1 everywhere: colours are compared", name);
}

} // namespace burnish
