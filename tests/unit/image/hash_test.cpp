#include "core/base/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace burnish {
namespace {

std::uint64_t of(const std::string& text, std::uint64_t seed = 0)
{
    return hash_bytes(text.data(), text.size(), seed);
}

TEST(hash, equals_published_xxhash64_values)
{
    EXPECT_EQ(of(""), 0xEF46DB3751D8E999ull);
    EXPECT_EQ(of("a"), 0xD24EC4F1A98C6E5Bull);
    EXPECT_EQ(of("abc"), 0x44BC2CF5AD770999ull);
    EXPECT_EQ(of("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1ull);
}

TEST(hash, of_parts_is_the_hash_of_all_at_once)
{
    unsigned char bytes[200];
    for (std::size_t i = 0; i < sizeof bytes; ++i)
        bytes[i] = static_cast<unsigned char>(i * 37 + i / 7);
    for (std::size_t size = 0; size <= sizeof bytes; ++size)
        for (const std::size_t part : {std::size_t{1}, std::size_t{3}, std::size_t{31}, std::size_t{32}, std::size_t{65}}) {
            HashStream stream(size);
            for (std::size_t at = 0; at < size; at += part)
                stream.add(bytes + at, std::min(part, size - at));
            stream.add(bytes, 0);
            ASSERT_EQ(stream.value(), hash_bytes(bytes, size, size)) << size << " by " << part;
        }
}

// The buffer and values of the reference implementation's sanity check.
TEST(hash, equals_reference_sanity_values)
{
    constexpr std::uint32_t kSeed = 2654435761u;
    unsigned char buffer[222];
    std::uint64_t state = kSeed;
    for (unsigned char& byte : buffer) {
        byte = static_cast<unsigned char>(state >> 56);
        state *= 11400714785074694797ull;
    }
    EXPECT_EQ(hash_bytes(buffer, 0, kSeed), 0xAC75FDA2929B17EFull);
    EXPECT_EQ(hash_bytes(buffer, 1), 0xE934A84ADB052768ull);
    EXPECT_EQ(hash_bytes(buffer, 1, kSeed), 0x5014607643A9B4C3ull);
    EXPECT_EQ(hash_bytes(buffer, 4), 0x9136A0DCA57457EEull);
    EXPECT_EQ(hash_bytes(buffer, 14), 0x8282DCC4994E35C8ull);
    EXPECT_EQ(hash_bytes(buffer, 14, kSeed), 0xC3BD6BF63DEB6DF0ull);
    EXPECT_EQ(hash_bytes(buffer, 222), 0xB641AE8CB691C174ull);
    EXPECT_EQ(hash_bytes(buffer, 222, kSeed), 0x20CB8AB7AE10C14Aull);
}

TEST(hash, alignment_does_not_matter_and_every_byte_does)
{
    std::vector<unsigned char> bytes(101, 7);
    const std::uint64_t whole = hash_bytes(bytes.data(), 100);
    EXPECT_EQ(hash_bytes(bytes.data() + 1, 100), whole);
    for (std::size_t i = 0; i < 100; ++i) {
        ++bytes[i];
        EXPECT_NE(hash_bytes(bytes.data(), 100), whole) << i;
        --bytes[i];
    }
}

TEST(hash, nothing_may_be_hashed)
{
    EXPECT_EQ(hash_bytes(nullptr, 0), 0xEF46DB3751D8E999ull);
}

} // namespace
} // namespace burnish
