#include "apps/bake/texture_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "core/base/check.h"
#include "core/simd/half.h"

namespace burnish {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr float kMostHalf = 65504.0f;

// Appends a number of `count` bytes, lowest first.
void put(Bytes& bytes, std::uint64_t value, int count)
{
    for (int i = 0; i < count; ++i)
        bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

void put_text(Bytes& bytes, std::string_view text)
{
    bytes.insert(bytes.end(), text.begin(), text.end());
}

void pad(Bytes& bytes, std::size_t to)
{
    bytes.resize((bytes.size() + to - 1) / to * to);
}

int bytes_of_channel(TexelType type)
{
    return type == TexelType::half ? 2 : 4;
}

void put_texels(Bytes& bytes, const float* texels, std::size_t count, TexelType type)
{
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t bits = 0;
        if (type == TexelType::half)
            bits = float_to_half(std::clamp(texels[i], -kMostHalf, kMostHalf));
        else
            std::memcpy(&bits, &texels[i], sizeof bits);
        put(bytes, bits, bytes_of_channel(type));
    }
}

void check(const TextureData& texture)
{
    BN_CHECK((texture.channels == 2 || texture.channels == 4) && (texture.faces == 1 || texture.faces == 6) && !texture.levels.empty());
    for (std::size_t l = 0; l < texture.levels.size(); ++l) {
        const TextureLevel &level = texture.levels[l], &first = texture.levels[0];
        BN_CHECK(level.width == std::max(first.width >> l, 1) && level.height == std::max(first.height >> l, 1));
        BN_CHECK(level.texels.size() == static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) *
                                            static_cast<std::size_t>(texture.channels * texture.faces));
    }
}

// The basic data format descriptor of float channels: linear light, primaries of BT.709.
Bytes ktx2_descriptor(int channels, TexelType type)
{
    constexpr std::uint32_t kMinusOne = 0xbf800000, kOne = 0x3f800000; // bits of floats
    constexpr int kIds[] = {0, 1, 2, 15};                              // red, green, blue, alpha
    constexpr int kSigned = 0x40, kFloat = 0x80;
    constexpr int kRgbColours = 1, kBt709 = 1, kLinear = 1;
    const int size = 24 + 16 * channels, channel = bytes_of_channel(type);
    Bytes bytes;
    put(bytes, static_cast<std::uint64_t>(size + 4), 4);
    put(bytes, 0, 4); // Khronos' basic descriptor
    put(bytes, 2, 2), put(bytes, static_cast<std::uint64_t>(size), 2);
    put(bytes, kRgbColours, 1), put(bytes, kBt709, 1), put(bytes, kLinear, 1), put(bytes, 0, 1);
    put(bytes, 0, 4);                                                                              // blocks of one texel
    put(bytes, static_cast<std::uint64_t>(channels * channel), 1), bytes.resize(bytes.size() + 7); // bytes of a texel
    for (int c = 0; c < channels; ++c) {
        put(bytes, static_cast<std::uint64_t>(8 * channel * c), 2);
        put(bytes, static_cast<std::uint64_t>(8 * channel - 1), 1);
        put(bytes, static_cast<std::uint64_t>(kIds[c] | kSigned | kFloat), 1);
        put(bytes, 0, 4);
        put(bytes, kMinusOne, 4), put(bytes, kOne, 4);
    }
    return bytes;
}

Bytes ktx2_pairs()
{
    Bytes bytes;
    for (const auto& [key, value] : {std::pair<std::string, std::string>{"KTXorientation", "rd"}, {"KTXwriter", "burnish"}}) {
        put(bytes, key.size() + value.size() + 2, 4);
        put_text(bytes, key), put(bytes, 0, 1), put_text(bytes, value), put(bytes, 0, 1);
        pad(bytes, 4);
    }
    return bytes;
}

} // namespace

std::uint64_t count_beyond_half(const TextureData& texture)
{
    std::uint64_t beyond = 0;
    for (const TextureLevel& level : texture.levels)
        beyond += static_cast<std::uint64_t>(
            std::count_if(level.texels.begin(), level.texels.end(), [](float v) { return !(std::fabs(v) <= kMostHalf); }));
    return beyond;
}

Bytes ktx2_bytes(const TextureData& texture, TexelType type)
{
    check(texture);
    constexpr int kFormats[2][2] = {{83, 97}, {103, 109}}; // VkFormat: R16G16, R16G16B16A16, R32G32, R32G32B32A32 _SFLOAT
    constexpr std::size_t kHeader = 80, kLevelEntry = 24;
    const std::size_t levels = texture.levels.size();
    const Bytes descriptor = ktx2_descriptor(texture.channels, type), pairs = ktx2_pairs();
    const std::size_t descriptor_at = kHeader + kLevelEntry * levels, pairs_at = descriptor_at + descriptor.size();
    const auto texel = static_cast<std::size_t>(texture.channels * bytes_of_channel(type)); // a multiple of 4
    // Lay out the levels, the smallest first
    std::vector<std::size_t> at(levels), size(levels);
    std::size_t end = pairs_at + pairs.size();
    for (std::size_t l = levels; l-- > 0;) {
        at[l] = (end + texel - 1) / texel * texel;
        size[l] = texture.levels[l].texels.size() * static_cast<std::size_t>(bytes_of_channel(type));
        end = at[l] + size[l];
    }
    // Write header, index, descriptor and pairs
    Bytes bytes;
    bytes.reserve(end);
    put_text(bytes, "\xabKTX 20\xbb\r\n\x1a\n");
    put(bytes, static_cast<std::uint64_t>(kFormats[type == TexelType::half ? 0 : 1][texture.channels == 2 ? 0 : 1]), 4);
    put(bytes, static_cast<std::uint64_t>(bytes_of_channel(type)), 4);
    put(bytes, static_cast<std::uint64_t>(texture.levels[0].width), 4), put(bytes, static_cast<std::uint64_t>(texture.levels[0].height), 4);
    put(bytes, 0, 4), put(bytes, 0, 4); // neither a volume nor an array
    put(bytes, static_cast<std::uint64_t>(texture.faces), 4), put(bytes, levels, 4), put(bytes, 0, 4);
    put(bytes, descriptor_at, 4), put(bytes, descriptor.size(), 4);
    put(bytes, pairs_at, 4), put(bytes, pairs.size(), 4);
    put(bytes, 0, 8), put(bytes, 0, 8); // no data of a compression
    for (std::size_t l = 0; l < levels; ++l)
        put(bytes, at[l], 8), put(bytes, size[l], 8), put(bytes, size[l], 8);
    bytes.insert(bytes.end(), descriptor.begin(), descriptor.end());
    bytes.insert(bytes.end(), pairs.begin(), pairs.end());
    for (std::size_t l = levels; l-- > 0;) {
        bytes.resize(at[l]);
        put_texels(bytes, texture.levels[l].texels.data(), texture.levels[l].texels.size(), type);
    }
    return bytes;
}

Bytes dds_bytes(const TextureData& texture, TexelType type)
{
    check(texture);
    constexpr int kFormats[2][2] = {{34, 10}, {16, 2}};             // DXGI_FORMAT: R16G16, R16G16B16A16, R32G32, R32G32B32A32 _FLOAT
    constexpr std::uint32_t kFlags = 0x2100f;                       // caps, height, width, pitch, format, mip levels
    constexpr std::uint32_t kTexture = 0x1000, kComplex = 0x400008; // the latter: mip levels, several surfaces
    constexpr std::uint32_t kCubeOfSixFaces = 0xfe00, kTexture2d = 3, kCube = 4, kDx10 = 0x30315844, kFourCc = 4;
    const bool cube = texture.faces == 6;
    const TextureLevel& first = texture.levels[0];
    const auto channel = static_cast<std::size_t>(bytes_of_channel(type)), channels = static_cast<std::size_t>(texture.channels);
    Bytes bytes;
    put_text(bytes, "DDS ");
    put(bytes, 124, 4), put(bytes, kFlags, 4);
    put(bytes, static_cast<std::uint64_t>(first.height), 4), put(bytes, static_cast<std::uint64_t>(first.width), 4);
    put(bytes, static_cast<std::uint64_t>(first.width) * channel * channels, 4);
    put(bytes, 0, 4), put(bytes, texture.levels.size(), 4);
    bytes.resize(bytes.size() + 44);
    put(bytes, 32, 4), put(bytes, kFourCc, 4), put(bytes, kDx10, 4), bytes.resize(bytes.size() + 20);
    put(bytes, kTexture | (cube || texture.levels.size() > 1 ? kComplex : 0), 4);
    put(bytes, cube ? kCubeOfSixFaces : 0, 4), bytes.resize(bytes.size() + 12);
    put(bytes, static_cast<std::uint64_t>(kFormats[type == TexelType::half ? 0 : 1][texture.channels == 2 ? 0 : 1]), 4);
    put(bytes, kTexture2d, 4), put(bytes, cube ? kCube : 0, 4), put(bytes, 1, 4), put(bytes, 0, 4);
    for (std::size_t face = 0; face < static_cast<std::size_t>(texture.faces); ++face)
        for (const TextureLevel& level : texture.levels) {
            const std::size_t count = level.texels.size() / static_cast<std::size_t>(texture.faces);
            put_texels(bytes, level.texels.data() + face * count, count, type);
        }
    return bytes;
}

} // namespace burnish
