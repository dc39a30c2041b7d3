// Appends raw bytes to a byte buffer.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace burnish {

// Appends `size` bytes to the end of `to`. `data` may be nullptr where `size` is 0.
inline void append_bytes(std::vector<std::uint8_t>& to, const void* data, std::size_t size)
{
    const std::size_t at = to.size();
    to.resize(at + size);
    if (size)
        std::memcpy(to.data() + at, data, size);
}

} // namespace burnish
