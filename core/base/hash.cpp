#include "core/base/hash.h"

#include <bit>
#include <cstring>

namespace burnish {
namespace {

// The five primes from the specification.
constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87ull;
constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4Full;
constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9ull;
constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63ull;
constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5ull;

template <class Word> std::uint64_t read_little_endian(const unsigned char* from)
{
    Word word;
    std::memcpy(&word, from, sizeof(word));
    if constexpr (std::endian::native == std::endian::big) {
        Word swapped = 0;
        for (std::size_t i = 0; i < sizeof(Word); ++i)
            swapped = static_cast<Word>(swapped << 8 | from[sizeof(Word) - 1 - i]);
        word = swapped;
    }
    return word;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t word)
{
    return std::rotl(lane + word * kPrime2, 31) * kPrime1;
}

std::uint64_t merge(std::uint64_t hash, std::uint64_t lane)
{
    return (hash ^ round(0, lane)) * kPrime1 + kPrime4;
}

// Hashes 32-byte stripes in four lanes, and advances `at` past the last whole stripe.
std::uint64_t hash_stripes(const unsigned char*& at, const unsigned char* end, std::uint64_t seed)
{
    std::uint64_t a = seed + kPrime1 + kPrime2;
    std::uint64_t b = seed + kPrime2;
    std::uint64_t c = seed;
    std::uint64_t d = seed - kPrime1;
    for (; end - at >= 32; at += 32) {
        a = round(a, read_little_endian<std::uint64_t>(at));
        b = round(b, read_little_endian<std::uint64_t>(at + 8));
        c = round(c, read_little_endian<std::uint64_t>(at + 16));
        d = round(d, read_little_endian<std::uint64_t>(at + 24));
    }
    const std::uint64_t hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
    return merge(merge(merge(merge(hash, a), b), c), d);
}

} // namespace

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed)
{
    const unsigned char* at = static_cast<const unsigned char*>(data);
    const unsigned char* const end = size ? at + size : at;
    std::uint64_t hash = size >= 32 ? hash_stripes(at, end, seed) : seed + kPrime5;
    hash += size;
    for (; end - at >= 8; at += 8)
        hash = std::rotl(hash ^ round(0, read_little_endian<std::uint64_t>(at)), 27) * kPrime1 + kPrime4;
    if (end - at >= 4) {
        hash = std::rotl(hash ^ (read_little_endian<std::uint32_t>(at) * kPrime1), 23) * kPrime2 + kPrime3;
        at += 4;
    }
    for (; at != end; ++at)
        hash = std::rotl(hash ^ (*at * kPrime5), 11) * kPrime1;
    hash = (hash ^ (hash >> 33)) * kPrime2;
    hash = (hash ^ (hash >> 29)) * kPrime3;
    return hash ^ (hash >> 32);
}

} // namespace burnish
