#include "core/base/hash.h"

#include <algorithm>
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

void start_lanes(std::uint64_t seed, std::uint64_t lanes[4])
{
    lanes[0] = seed + kPrime1 + kPrime2, lanes[1] = seed + kPrime2, lanes[2] = seed, lanes[3] = seed - kPrime1;
}

// Hashes 32-byte stripes in four lanes. Returns the end of the last whole stripe.
const unsigned char* add_stripes(const unsigned char* at, const unsigned char* end, std::uint64_t lanes[4])
{
    std::uint64_t a = lanes[0], b = lanes[1], c = lanes[2], d = lanes[3];
    for (; end - at >= 32; at += 32) {
        a = round(a, read_little_endian<std::uint64_t>(at));
        b = round(b, read_little_endian<std::uint64_t>(at + 8));
        c = round(c, read_little_endian<std::uint64_t>(at + 16));
        d = round(d, read_little_endian<std::uint64_t>(at + 24));
    }
    lanes[0] = a, lanes[1] = b, lanes[2] = c, lanes[3] = d;
    return at;
}

// Returns the hash from the lanes, the bytes behind the last whole stripe and the number of all bytes.
std::uint64_t finish(const std::uint64_t lanes[4], const unsigned char* at, const unsigned char* end, std::uint64_t size,
                     std::uint64_t seed)
{
    std::uint64_t hash = seed + kPrime5;
    if (size >= 32) {
        hash = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) + std::rotl(lanes[3], 18);
        for (int i = 0; i < 4; ++i)
            hash = merge(hash, lanes[i]);
    }
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

} // namespace

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed)
{
    const unsigned char* const at = static_cast<const unsigned char*>(data);
    const unsigned char* const end = size ? at + size : at;
    std::uint64_t lanes[4];
    start_lanes(seed, lanes);
    return finish(lanes, add_stripes(at, end, lanes), end, size, seed);
}

HashStream::HashStream(std::uint64_t seed) : seed_(seed)
{
    start_lanes(seed, lanes_);
}

void HashStream::add(const void* data, std::size_t size)
{
    const unsigned char* at = static_cast<const unsigned char*>(data);
    const unsigned char* const end = size ? at + size : at;
    // Fill a stripe that has begun
    const std::size_t begun = size_ % kStripe;
    size_ += size;
    if (begun > 0) {
        const std::size_t more = std::min(kStripe - begun, size);
        std::copy_n(at, more, rest_ + begun);
        at += more;
        if (begun + more < kStripe)
            return;
        add_stripes(rest_, rest_ + kStripe, lanes_);
    }
    at = add_stripes(at, end, lanes_);
    std::copy(at, end, rest_);
}

std::uint64_t HashStream::value() const
{
    return finish(lanes_, rest_, rest_ + size_ % kStripe, size_, seed_);
}

} // namespace burnish
