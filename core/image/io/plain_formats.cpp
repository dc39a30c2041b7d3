#include "core/image/io/plain_formats.h"

#include <bit>
#include <cstring>
#include <string>

#include "core/base/check.h"

namespace burnish {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are stored as they lie in memory");

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& out, std::uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; ++i)
        out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

// Appends a directory entry of TIFF 6.0 section 2. Type 3 is 16-bit, type 4 is 32-bit.
void append_field(Bytes& out, int tag, int type, std::uint64_t count, std::uint64_t value)
{
    append(out, static_cast<std::uint64_t>(tag), 2);
    append(out, static_cast<std::uint64_t>(type), 2);
    append(out, count, 4);
    append(out, value, 4);
}

} // namespace

Bytes encode_pfm(const Image& image)
{
    BN_CHECK(image.type == PixelType::f32 && (image.channels == 1 || image.channels == 3));
    const std::string header = std::string(image.channels == 3 ? "PF" : "Pf") + "\n" + std::to_string(image.width) + " " +
                               std::to_string(image.height) + "\n-1.0\n";
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels) * 4;
    const std::size_t rows = static_cast<std::size_t>(image.height);
    Bytes bytes(header.size() + image.bytes.size());
    std::memcpy(bytes.data(), header.data(), header.size());
    for (std::size_t y = 0; y < rows; ++y)
        std::memcpy(bytes.data() + header.size() + y * row, image.bytes.data() + (rows - 1 - y) * row, row);
    return bytes;
}

Bytes encode_tiff(const Image& image)
{
    BN_CHECK(image.type == PixelType::u8);
    const std::uint64_t channels = static_cast<std::uint64_t>(image.channels);
    const std::uint64_t alpha = channels % 2 == 0;
    const std::uint64_t fields = 10 + alpha;
    const std::uint64_t depths_at = 8 + 2 + fields * 12 + 4; // after the directory
    const std::uint64_t pixels_at = depths_at + 8;
    constexpr int kShort = 3, kLong = 4;
    Bytes out;
    out.reserve(pixels_at + image.bytes.size());
    append(out, 0x002A4949, 4); // "II", 42
    append(out, 8, 4);
    append(out, fields, 2);
    append_field(out, 256, kLong, 1, static_cast<std::uint64_t>(image.width));
    append_field(out, 257, kLong, 1, static_cast<std::uint64_t>(image.height));
    // BitsPerSample: the entry itself holds up to two values.
    append_field(out, 258, kShort, channels, channels == 1 ? 8 : channels == 2 ? 0x00080008 : depths_at);
    append_field(out, 259, kShort, 1, 1);                     // no compression
    append_field(out, 262, kShort, 1, channels >= 3 ? 2 : 1); // RGB, or gray with black as zero
    append_field(out, 273, kLong, 1, pixels_at);              // the strip
    append_field(out, 277, kShort, 1, channels);
    append_field(out, 278, kLong, 1, static_cast<std::uint64_t>(image.height));
    append_field(out, 279, kLong, 1, image.bytes.size());
    append_field(out, 284, kShort, 1, 1); // interleaved
    if (alpha)
        append_field(out, 338, kShort, 1, 2); // unassociated alpha
    append(out, 0, 4);                        // no further directory
    for (int i = 0; i < 4; ++i)
        append(out, 8, 2);
    const std::uint8_t* pixels = reinterpret_cast<const std::uint8_t*>(image.bytes.data());
    out.insert(out.end(), pixels, pixels + image.bytes.size());
    return out;
}

} // namespace burnish
