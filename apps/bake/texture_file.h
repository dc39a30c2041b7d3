// Texture files that engines load as they are: KTX2 and DDS, with linear floats, all faces and all mip levels.
#pragma once
#include <cstdint>
#include <vector>

namespace burnish {

struct TextureLevel {
    int width = 0, height = 0;
    std::vector<float> texels; // face by face, rows from the top, channels interleaved
};

struct TextureData {
    int channels = 4;                 // 2 (red, green) or 4
    int faces = 1;                    // 6: a cube, +x -x +y -y +z -z
    std::vector<TextureLevel> levels; // largest first, each side half of the one before, at least 1
};

enum class TexelType { half, whole }; // 16 or 32 bits a channel

// Returns the number of values that a half float cannot hold: beyond 65504, or not finite.
std::uint64_t count_beyond_half(const TextureData& texture);

// Encodes a texture. Values beyond half floats become 65504. Formats: Khronos, "KTX File Format Specification" 2.0; Microsoft, "DDS
// file layout", with a DX10 header.
std::vector<std::uint8_t> ktx2_bytes(const TextureData& texture, TexelType type);
std::vector<std::uint8_t> dds_bytes(const TextureData& texture, TexelType type);

} // namespace burnish
