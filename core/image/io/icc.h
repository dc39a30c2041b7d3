// ICC colour profiles: tells whether a profile means sRGB.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace burnish {

// Returns a warning about a profile (ICC.1:2022) with other primaries or another tone curve than sRGB's, without the
// file name. Returns nothing for sRGB and for grey. A damaged profile gives a warning, too.
std::string profile_warning(const std::uint8_t* data, std::size_t size);

} // namespace burnish
