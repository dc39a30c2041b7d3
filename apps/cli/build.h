// Which build this program is.
#pragma once
#include <cstdint>

namespace burnish {

// Returns a hash over this executable's bytes, read once: another build may render other pixels.
std::uint64_t program_hash();

} // namespace burnish
