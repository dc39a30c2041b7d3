// Inflates zlib streams.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burnish {

// Inflates a zlib stream (RFC 1950). Returns nothing where the stream is damaged, or longer than `most` bytes.
std::vector<std::uint8_t> inflated(const std::uint8_t* data, std::size_t size, std::size_t most);

} // namespace burnish
