// Files whose checksums stop a fuzzer: with `sealed`, the bytes get their right length and checksums.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/base/hash.h"

// Writes the hash of bytes [begin, end) to `at`.
inline void seal(std::vector<std::uint8_t>& bytes, std::size_t begin, std::size_t end, std::size_t at)
{
    const std::uint64_t hash = burnish::hash_bytes(bytes.data() + begin, end - begin);
    std::memcpy(bytes.data() + at, &hash, sizeof(hash));
}
