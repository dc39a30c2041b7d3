// Guards PNG files (W3C PNG, third edition). Walks the chunks, checks their checksums, and passes on only the chunks
// that affect the stored samples. Text, profiles and the like cost time and memory, and libpng prints its warnings
// about them on stderr.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "core/image/io/guard.h"

namespace burnish {
namespace {

// Best compression ratio: deflate's longest match, 258 bytes, costs at least 2 bits, 1032 to 1 (RFC 1951 section
// 3.2.5).
constexpr std::uint64_t kDeflateBest = 1032;

std::uint32_t read32(const std::uint8_t* at)
{
    return static_cast<std::uint32_t>(at[0]) << 24 | static_cast<std::uint32_t>(at[1]) << 16 | static_cast<std::uint32_t>(at[2]) << 8 |
           at[3];
}

// Checksum of the standard's annex D, four bytes at a time: table[k] moves a byte on by k bytes.
class Crc {
  public:
    Crc()
    {
        for (std::uint32_t n = 0; n < 256; ++n) {
            std::uint32_t c = n;
            for (int bit = 0; bit < 8; ++bit)
                c = c >> 1 ^ (c & 1 ? 0xEDB88320u : 0u);
            table_[0][n] = c;
        }
        for (std::size_t k = 1; k < 4; ++k)
            for (std::size_t n = 0; n < 256; ++n)
                table_[k][n] = table_[k - 1][n] >> 8 ^ table_[0][table_[k - 1][n] & 0xFF];
    }
    std::uint32_t of(const std::uint8_t* at, std::size_t size) const
    {
        std::uint32_t c = 0xFFFFFFFFu;
        for (; size >= 4; at += 4, size -= 4)
            c = table_[3][(c ^ at[0]) & 0xFF] ^ table_[2][(c >> 8 ^ at[1]) & 0xFF] ^ table_[1][(c >> 16 ^ at[2]) & 0xFF] ^
                table_[0][c >> 24 ^ at[3]];
        for (; size > 0; ++at, --size)
            c = c >> 8 ^ table_[0][(c ^ *at) & 0xFF];
        return ~c;
    }

  private:
    std::array<std::array<std::uint32_t, 256>, 4> table_;
};

struct Header {
    std::uint64_t width = 0, height = 0;
    unsigned depth = 0, colour_type = 0;
};

bool depth_fits(unsigned depth, unsigned colour_type)
{
    const bool power_of_two = depth == 1 || depth == 2 || depth == 4 || depth == 8 || depth == 16;
    switch (colour_type) {
    case 0:
        return power_of_two;
    case 3:
        return power_of_two && depth <= 8;
    case 2:
    case 4:
    case 6:
        return depth == 8 || depth == 16;
    default:
        return false;
    }
}

// Checks IHDR. `data` is its content, 13 bytes at byte 16 of the file.
Status check_header(const ImageBytes& file, const std::uint8_t* data, const Limits& limits, Header& header)
{
    header = {read32(data), read32(data + 4), data[8], data[9]};
    BN_TRY(check_sides(file, static_cast<std::int64_t>(header.width), static_cast<std::int64_t>(header.height), limits));
    if (!depth_fits(header.depth, header.colour_type))
        return file.error("byte 24", fmt::format("bit depth {} with colour type {} is no PNG", header.depth, header.colour_type));
    if (data[10] != 0 || data[11] != 0 || data[12] > 1)
        return file.error("byte 26", "an unknown compression, filter or interlace method");
    constexpr std::uint64_t kSamplesByColourType[] = {1, 0, 3, 1, 2, 0, 4};
    const std::uint64_t row_bits = header.width * header.depth * kSamplesByColourType[header.colour_type];
    if (header.height * (row_bits / 8) / kDeflateBest > file.size)
        return file.error(fmt::format("header: {} x {} pixels", header.width, header.height),
                          fmt::format("{} bytes cannot hold that many pixels", file.size));
    const std::uint64_t channels = header.colour_type == 3 ? 4 : kSamplesByColourType[header.colour_type];
    return check_proportion(file, header.width, header.height, channels * (header.depth > 8 ? 2 : 1));
}

// Checks that palette and transparency have sizes that fit the header. `entries` is the palette's length once known.
Status check_colours(const ImageBytes& file, std::size_t at, std::string_view type, std::size_t length, const Header& header,
                     std::size_t& entries)
{
    const std::string place = fmt::format("byte {}", at);
    if (type == "PLTE") {
        const bool possible = header.colour_type == 2 || header.colour_type == 3 || header.colour_type == 6;
        if (!possible || entries || length == 0 || length % 3 != 0 || length > 768)
            return file.error(place, fmt::format("a palette of {} bytes does not belong here", length));
        entries = length / 3;
    } else if (type == "tRNS") {
        const bool sound = header.colour_type == 0   ? length == 2
                           : header.colour_type == 2 ? length == 6
                                                     : header.colour_type == 3 && length >= 1 && length <= entries;
        if (!sound)
            return file.error(place, fmt::format("transparency of {} bytes does not belong here", length));
    }
    return {};
}

// Colour words of a PNG. The first that is present counts: cICP, iCCP, sRGB, then gAMA and cHRM.
struct ColourChunks {
    bool coded = false, profile = false, srgb = false;
    std::string of_code, of_gamma, of_primaries; // warnings
};

void read_colour_chunk(std::string_view type, const std::uint8_t* data, std::size_t length, bool in_colour, ColourChunks& chunks,
                       StoredColour& colour)
{
    if (type == "cICP" && length == 4) {
        chunks.coded = true;
        if (data[0] != 1 || data[1] != 13) // Rec.709 primaries, sRGB's curve
            chunks.of_code = fmt::format("its cICP names primaries {} and curve {}; its colours are taken as sRGB", data[0], data[1]);
    } else if (type == "iCCP" && !chunks.profile) {
        const void* const end = std::memchr(data, 0, std::min<std::size_t>(length, 80)); // of the name; a method follows
        if (end == nullptr)
            return;
        const std::size_t begin = static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - data) + 2;
        if (begin < length) {
            chunks.profile = colour.deflated = true;
            colour.profile.assign(data + begin, data + length);
        }
    } else if (type == "sRGB") {
        chunks.srgb = true;
    } else if (type == "gAMA" && length == 4) {
        const std::uint32_t gamma = read32(data); // 100000 times the exponent
        if (gamma < 40000 || gamma > 50000)
            chunks.of_gamma = fmt::format("its gAMA is {:g}; its colours are taken as sRGB", gamma / 100000.0);
    } else if (type == "cHRM" && length == 32 && in_colour) {
        Primaries p; // the file has white first
        for (std::size_t i = 0; i < 8; ++i)
            p[(i + 6) % 8] = read32(data + 4 * i) / 100000.0;
        for (std::size_t i = 0; i < 8; ++i)
            if (std::abs(p[i] - kRec709Primaries[i]) > 0.005)
                chunks.of_primaries = "its cHRM names other primaries than Rec.709; its colours are taken as sRGB";
    }
}

// Keeps what counts.
void settle_colour(const ColourChunks& chunks, StoredColour& colour)
{
    std::vector<std::string> found;
    if (chunks.coded)
        found = {chunks.of_code};
    else if (!chunks.profile && !chunks.srgb)
        found = {chunks.of_gamma, chunks.of_primaries};
    if (chunks.coded)
        colour.profile.clear();
    for (const std::string& warning : found)
        if (!warning.empty())
            colour.warnings.push_back(warning);
}

} // namespace

Result<ImageProbe> probe_png(const ImageBytes& file, const Limits& limits)
{
    static const Crc crc;
    ImageProbe probe{"png"};
    probe.replacement.assign(file.data, file.data + std::min<std::size_t>(8, file.size));
    Header header;
    std::size_t palette_entries = 0;
    bool pixels = false, pixels_over = false;
    ColourChunks colours;
    for (std::size_t at = 8;;) {
        const std::string place = fmt::format("byte {}", at);
        if (at + 12 > file.size)
            return file.error(place, "the file ends before its IEND chunk");
        const std::size_t length = read32(file.data + at);
        const std::string_view type(reinterpret_cast<const char*>(file.data + at + 4), 4);
        // Check the header first: report an absurd size before computing any checksum.
        if (at == 8 && (type != "IHDR" || length != 13 || at + 25 > file.size))
            return file.error(place, "a PNG file must begin with a whole IHDR chunk");
        if (at == 8)
            BN_TRY(check_header(file, file.data + 16, limits, header));
        // Check the chunk's size and checksum
        if (length > file.size - at - 12)
            return file.error(place, fmt::format("a chunk of {} bytes does not fit into the file", length));
        if (crc.of(file.data + at + 4, length + 4) != read32(file.data + at + 8 + length))
            return file.error(place, "the checksum of a chunk is wrong");
        // Check the chunk's type and order
        const bool critical = (file.data[at + 4] & 0x20) == 0;
        const bool known = type == "IHDR" || type == "PLTE" || type == "IDAT" || type == "IEND";
        if ((critical && !known) || (at != 8 && type == "IHDR") || (type == "IDAT" && pixels_over) ||
            (pixels && (type == "PLTE" || type == "tRNS")))
            return file.error(place, "a chunk of an unknown type or at a wrong place");
        BN_TRY(check_colours(file, at, type, length, header, palette_entries));
        pixels_over = pixels && type != "IDAT";
        pixels = pixels || type == "IDAT";
        if (!pixels)
            read_colour_chunk(type, file.data + at + 8, length, (header.colour_type & 2) != 0, colours, probe.colour);
        // Pass on chunks that affect the samples
        if (known || type == "tRNS")
            probe.replacement.insert(probe.replacement.end(), file.data + at, file.data + at + 12 + length);
        if (type == "IEND")
            break;
        at += 12 + length;
    }
    settle_colour(colours, probe.colour);
    if (probe.replacement.size() == file.size)
        probe.replacement.clear(); // no chunk was dropped
    if (!pixels || (header.colour_type == 3 && palette_entries == 0))
        return file.error("", "the file has no pixels or no palette");
    return probe;
}

} // namespace burnish
