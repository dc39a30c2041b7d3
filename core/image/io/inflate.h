// Inflates and deflates zlib streams.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace burnish {

// Inflates a zlib stream (RFC 1950). Returns nothing where the stream is damaged, or longer than `most` bytes.
std::vector<std::uint8_t> inflated(const std::uint8_t* data, std::size_t size, std::size_t most);

// Makes a zlib stream as small as zlib can. Returns nothing without memory, or in a program without libraries.
std::vector<std::uint8_t> deflated(const std::uint8_t* data, std::size_t size);

} // namespace burnish
