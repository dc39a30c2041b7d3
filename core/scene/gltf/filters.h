// Decoding filters of EXT_meshopt_compression, Appendix B, in portable arithmetic. The library's SIMD versions use
// reciprocal square root estimates, which differ between processors.
#pragma once
#include <cstddef>
#include <cstdint>

namespace burnish::gltf {

void filter_octahedral(std::uint8_t* bytes, std::size_t count, std::size_t stride); // stride 4 or 8
void filter_quaternion(std::uint8_t* bytes, std::size_t count);                     // stride 8
void filter_exponential(std::uint8_t* bytes, std::size_t words);                    // 32-bit words

} // namespace burnish::gltf
