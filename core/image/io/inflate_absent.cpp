// Replaces inflate.cpp in a program without libraries, which reads no PNG.
#include "core/image/io/inflate.h"

namespace burnish {

std::vector<std::uint8_t> inflated(const std::uint8_t*, std::size_t, std::size_t)
{
    return {};
}

std::vector<std::uint8_t> deflated(const std::uint8_t*, std::size_t)
{
    return {};
}

} // namespace burnish
