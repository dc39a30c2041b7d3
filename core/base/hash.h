// Content hash: 64 bits, equal on every machine.
#pragma once
#include <cstddef>
#include <cstdint>

namespace burnish {

// Returns the xxHash64 of `data` (Collet, "xxHash fast digest algorithm", doc/xxhash_spec.md). Words are little-endian
// on every machine. Not cryptographic. Hashes of parts chain through `seed`.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);

// The hash of bytes that arrive part by part: hash_bytes() of all of them at once.
class HashStream {
  public:
    explicit HashStream(std::uint64_t seed = 0);
    void add(const void* data, std::size_t size);
    std::uint64_t value() const;

  private:
    static constexpr std::size_t kStripe = 32; // bytes
    std::uint64_t seed_, lanes_[4], size_ = 0;
    unsigned char rest_[kStripe] = {}; // size_ % kStripe bytes that fill no stripe yet
};

} // namespace burnish
