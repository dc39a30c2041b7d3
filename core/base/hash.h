// Content hash: 64 bits, equal on every machine.
#pragma once
#include <cstddef>
#include <cstdint>

namespace burnish {

// Returns the xxHash64 of `data` (Collet, "xxHash fast digest algorithm", doc/xxhash_spec.md). Words are little-endian
// on every machine. Not cryptographic. Hashes of parts chain through `seed`.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);

} // namespace burnish
