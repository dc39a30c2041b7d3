#include "core/image/io/inflate.h"

#include <zlib.h>

namespace burnish {

std::vector<std::uint8_t> inflated(const std::uint8_t* data, std::size_t size, std::size_t most)
{
    std::vector<std::uint8_t> out(most);
    uLongf length = static_cast<uLongf>(most);
    if (uncompress(out.data(), &length, data, static_cast<uLong>(size)) != Z_OK)
        return {};
    out.resize(length);
    return out;
}

std::vector<std::uint8_t> deflated(const std::uint8_t* data, std::size_t size)
{
    uLongf length = compressBound(static_cast<uLong>(size));
    std::vector<std::uint8_t> out(length);
    if (compress2(out.data(), &length, data, static_cast<uLong>(size), Z_BEST_COMPRESSION) != Z_OK)
        return {};
    out.resize(length);
    return out;
}

} // namespace burnish
