// Files whose checksums keep a fuzzer out: with `sealed`, the bytes are given the length and the checksums that they should have.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/base/hash.h"

// The hash of bytes [begin, end) goes to `at`.
inline void seal(std::vector<std::uint8_t>& bytes, std::size_t begin, std::size_t end, std::size_t at)
{
    const std::uint64_t hash = burnish::hash_bytes(bytes.data() + begin, end - begin);
    std::memcpy(bytes.data() + at, &hash, sizeof(hash));
}
