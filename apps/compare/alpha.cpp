#include "apps/compare/alpha.h"

#include <cstring>
#include <fmt/core.h>

namespace burnish {
namespace {

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

std::string drop_lone_alpha(Image& reference, const std::string& reference_name, Image& test, const std::string& test_name)
{
    const bool of_reference = reference.channels > test.channels;
    Image& with = of_reference ? reference : test;
    const Image& without = of_reference ? test : reference;
    const bool alike =
        with.width == without.width && with.height == without.height && (with.type == PixelType::f32) == (without.type == PixelType::f32);
    if (!alike || with.channels != without.channels + 1 || (with.channels != 2 && with.channels != 4))
        return "";
    drop_last_channel(with);
    return fmt::format("{} alone has alpha: colours are compared", of_reference ? reference_name : test_name);
}

} // namespace burnish
