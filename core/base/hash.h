// Content hash: 64 bits of arbitrary bytes, the same on every machine.
#pragma once
#include <cstddef>
#include <cstdint>

namespace burnish {

// xxHash64 as its specification defines it (Collet, "xxHash fast digest algorithm", doc/xxhash_spec.md),
// whose words are little-endian whatever the machine. Not cryptographic. Hashes of parts chain through
// `seed`.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);

} // namespace burnish
