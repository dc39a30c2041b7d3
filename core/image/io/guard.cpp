#include "core/image/io/guard.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace burnish {
namespace {

// Limit on scans in a progressive JPEG, because decoding time grows with the scans and the file sets their number. Real
// files have about ten.
constexpr int kMaxJpegScans = 200;

std::uint64_t big_endian(const std::uint8_t* at, int bytes)
{
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i)
        value = value << 8 | at[i];
    return value;
}

std::uint64_t little_endian(const std::uint8_t* at, int bytes)
{
    std::uint64_t value = 0;
    for (int i = bytes; i-- > 0;)
        value = value << 8 | at[i];
    return value;
}

bool starts_with(const ImageBytes& file, std::string_view magic, std::size_t offset = 0)
{
    return file.size >= offset + magic.size() && std::memcmp(file.data + offset, magic.data(), magic.size()) == 0;
}

Error too_short(const ImageBytes& file)
{
    return file.error(fmt::format("byte {}", file.size), "the file ends inside its header");
}

// Finds the next JPEG marker at or after `at` (ITU T.81 annex B), and moves `at` past the marker.
std::optional<std::uint8_t> next_jpeg_marker(const ImageBytes& file, std::size_t& at)
{
    while (at + 1 < file.size) {
        const void* found = std::memchr(file.data + at, 0xFF, file.size - at - 1);
        if (!found)
            return std::nullopt;
        at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - file.data);
        const std::uint8_t marker = file.data[at + 1];
        const bool restart = marker >= 0xD0 && marker <= 0xD7;
        at += marker == 0xFF ? 1 : 2; // any number of FF bytes may pad a marker
        if (marker != 0xFF && marker != 0x00 && !restart)
            return marker;
    }
    return std::nullopt;
}

Result<ImageProbe> probe_jpeg(const ImageBytes& file, const Limits& limits)
{
    ImageProbe probe{"jpeg"};
    bool framed = false;
    int scans = 0;
    for (std::size_t at = 2;;) {
        // Go to the next marker
        const std::optional<std::uint8_t> marker = next_jpeg_marker(file, at);
        if (!marker)
            return file.error(fmt::format("byte {}", file.size), "the file ends before its end-of-image marker");
        if (*marker == 0xD9 && framed && scans > 0)
            return probe;
        if (*marker == 0xD8 || *marker == 0xD9 || *marker == 0x01)
            continue;
        // Check the segment's size
        if (at + 2 > file.size)
            return too_short(file);
        const std::uint64_t length = big_endian(file.data + at, 2);
        if (length < 2 || at + length > file.size)
            return file.error(fmt::format("byte {}", at), fmt::format("a segment of {} bytes does not fit", length));
        // Take pieces of the colour profile (ICC.1:2022 annex B), which lie in order in most files
        constexpr std::string_view kPiece("ICC_PROFILE\0", 12);
        if (*marker == 0xE2 && length >= 16 && starts_with(file, kPiece, at + 2))
            probe.colour.profile.insert(probe.colour.profile.end(), file.data + at + 16, file.data + at + length);
        // Check the frame's sides
        const bool frame = *marker >= 0xC0 && *marker <= 0xCF && *marker != 0xC4 && *marker != 0xC8 && *marker != 0xCC;
        if (frame && length < 8)
            return file.error(fmt::format("byte {}", at), "the frame header is too short");
        if (frame) {
            const std::int64_t height = static_cast<std::int64_t>(big_endian(file.data + at + 3, 2));
            const std::int64_t width = static_cast<std::int64_t>(big_endian(file.data + at + 5, 2));
            BN_TRY(check_sides(file, width, height, limits));
            BN_TRY(check_proportion(file, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), 3));
            framed = true;
        }
        // Bound the number of scans
        if (*marker == 0xDA && ++scans > kMaxJpegScans)
            return file.error(fmt::format("byte {}", at), fmt::format("more than {} scans", kMaxJpegScans));
        at += length;
    }
}

// Reads WebP sizes (RFC 9649): the canvas of VP8X, or the frame of a simple file.
Result<ImageProbe> probe_webp(const ImageBytes& file, const Limits& limits)
{
    if (file.size < 30)
        return too_short(file);
    if (little_endian(file.data + 4, 4) + 8 > file.size)
        return file.error("byte 4", fmt::format("the file says {} bytes and has {}", little_endian(file.data + 4, 4) + 8, file.size));
    ImageProbe probe{"webp"};
    std::uint64_t width = 0, height = 0;
    if (starts_with(file, "VP8X", 12)) {
        if (file.size >= 38 && starts_with(file, "ICCP", 30)) { // the next chunk
            const std::size_t length = static_cast<std::size_t>(little_endian(file.data + 34, 4));
            probe.colour.profile.assign(file.data + 38, file.data + 38 + std::min(length, file.size - 38));
        }
        width = little_endian(file.data + 24, 3) + 1;
        height = little_endian(file.data + 27, 3) + 1;
    } else if (starts_with(file, "VP8L", 12)) {
        const std::uint64_t bits = little_endian(file.data + 21, 4);
        width = (bits & 0x3FFF) + 1;
        height = (bits >> 14 & 0x3FFF) + 1;
    } else if (starts_with(file, "VP8 ", 12)) {
        width = little_endian(file.data + 26, 2) & 0x3FFF;
        height = little_endian(file.data + 28, 2) & 0x3FFF;
    } else {
        return file.error("byte 12", "a WebP file without an image chunk");
    }
    BN_TRY(check_sides(file, static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), limits));
    BN_TRY(check_proportion(file, width, height, 4));
    return probe;
}

// Reads an unsigned decimal at `at` and moves `at` past it. Returns nothing for no number or an absurd one.
std::optional<std::int64_t> read_decimal(const ImageBytes& file, std::size_t& at)
{
    std::int64_t value = 0;
    const std::size_t begin = at;
    for (; at < file.size && file.data[at] >= '0' && file.data[at] <= '9'; ++at) {
        value = value * 10 + (file.data[at] - '0');
        if (value > 1'000'000'000'000)
            return std::nullopt;
    }
    return at == begin ? std::nullopt : std::optional(value);
}

// Skips white space and # comments.
void skip_blanks(const ImageBytes& file, std::size_t& at)
{
    bool comment = false;
    for (; at < file.size; ++at) {
        const char c = static_cast<char>(file.data[at]);
        if (c == '#')
            comment = true;
        if (!comment && (c == '\0' || std::strchr(" \t\r\n", c) == nullptr))
            return;
        if (c == '\n')
            comment = false;
    }
}

// Checks the scale in the header: the divisor of samples (Netpbm, except bitmaps), or the factor of PFM, whose sign is
// the byte order.
Status check_pnm_scale(const ImageBytes& file, std::size_t at)
{
    const char kind = static_cast<char>(file.data[1]);
    if (kind == '1' || kind == '4')
        return {};
    skip_blanks(file, at);
    const std::size_t begin = at;
    if (kind == 'F' || kind == 'f') {
        while (at < file.size && at - begin < 64 && file.data[at] > ' ')
            ++at;
        const char *first = reinterpret_cast<const char*>(file.data) + begin, *last = first + (at - begin);
        float scale = 0.0f;
        const bool plus = first != last && *first == '+', two_signs = plus && first + 1 != last && first[1] == '-';
        const std::from_chars_result read = std::from_chars(first + plus, last, scale);
        if (two_signs || read.ec != std::errc() || read.ptr != last || !std::isfinite(scale) || scale == 0.0f)
            return file.error(fmt::format("byte {}", begin), "a scale that is a number and not 0 should stand here");
        return {};
    }
    const std::optional<std::int64_t> most = read_decimal(file, at);
    if (!most || *most < 1 || *most > 65535)
        return file.error(fmt::format("byte {}", begin), "a largest value of 1 to 65535 should stand here");
    return {};
}

// Reads Netpbm and PFM headers: magic, then width, height and scale as text between white space and # comments.
Result<ImageProbe> probe_pnm(const ImageBytes& file, const Limits& limits)
{
    std::size_t at = 2;
    std::int64_t sides[2] = {0, 0};
    for (std::int64_t& side : sides) {
        skip_blanks(file, at);
        const std::optional<std::int64_t> read = read_decimal(file, at);
        if (!read)
            return file.error(fmt::format("byte {}", at), "a width or height should stand here");
        side = *read;
    }
    BN_TRY(check_sides(file, sides[0], sides[1], limits));
    const std::uint64_t pixels = static_cast<std::uint64_t>(sides[0]) * static_cast<std::uint64_t>(sides[1]);
    if (pixels / 8 > file.size) // a pixel takes at least one bit
        return file.error(fmt::format("header: {} x {} pixels", sides[0], sides[1]),
                          fmt::format("{} bytes cannot hold that many pixels", file.size));
    BN_TRY(check_pnm_scale(file, at));
    return ImageProbe{"pnm"};
}

Result<ImageProbe> probe_bmp(const ImageBytes& file, const Limits& limits)
{
    if (file.size < 30)
        return too_short(file);
    const bool core = little_endian(file.data + 14, 4) == 12; // OS/2 headers have 16-bit sides
    const int bytes = core ? 2 : 4;
    const auto side = [&](std::size_t at) {
        const std::int64_t value = static_cast<std::int64_t>(little_endian(file.data + at, bytes));
        return core || value < 0x80000000ll ? value : 0x100000000ll - value; // negative height: top row first
    };
    const std::int64_t width = side(18), height = side(core ? 20 : 22);
    BN_TRY(check_sides(file, width, height, limits));
    const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    const std::uint64_t bits = little_endian(file.data + (core ? 24 : 28), 2);
    const std::uint64_t method = core || file.size < 34 ? 0 : little_endian(file.data + 30, 4);
    const bool runs = method == 1 || method == 2; // run-length codes for 4 and 8 bits; pixels that the runs leave out are zero
    if (!runs && pixels / 8 * bits > file.size)
        return file.error(fmt::format("header: {} x {} pixels", width, height),
                          fmt::format("{} bytes cannot hold that many pixels", file.size));
    BN_TRY(check_proportion(file, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), 4));
    return ImageProbe{"bmp"};
}

bool is_pnm(const ImageBytes& file)
{
    return file.size > 3 && file.data[0] == 'P' && std::strchr("123456Ff", file.data[1]) && file.data[1] &&
           std::strchr(" \t\r\n#", file.data[2]) && file.data[2];
}

} // namespace

Status check_sides(const ImageBytes& file, std::int64_t width, std::int64_t height, const Limits& limits)
{
    if (width < 1 || height < 1)
        return file.error(fmt::format("header: {} x {} pixels", width, height), "an image needs at least one pixel");
    const bool wide = width > limits.image_side;
    if (wide || height > limits.image_side)
        return file.error(fmt::format("header: {} {}", wide ? "width" : "height", wide ? width : height),
                          fmt::format("more than the limit of {} pixels a side", limits.image_side));
    if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > limits.image_pixels)
        return file.error(fmt::format("header: {} x {} pixels", width, height),
                          fmt::format("more than the limit of {} pixels (of an environment: Limits::env_pixels)", limits.image_pixels));
    return {};
}

// Bounds formats that store runs and repeats in almost no space. Real images stay far below 4096 to 1. Small images may
// have any ratio.
Status check_proportion(const ImageBytes& file, std::uint64_t width, std::uint64_t height, std::uint64_t pixel_bytes)
{
    constexpr std::uint64_t kFreeBytes = 64ull << 20, kBest = 4096;
    const std::uint64_t bytes = width * height * pixel_bytes;
    if (bytes <= kFreeBytes || bytes / kBest <= file.size)
        return {};
    return file.error(fmt::format("header: {} x {} pixels", width, height),
                      fmt::format("{} bytes cannot hold that many pixels", file.size));
}

Result<ImageProbe> probe_image(const ImageBytes& file, const Limits& limits)
{
    if (starts_with(file, "\x89PNG\r\n\x1a\n"))
        return probe_png(file, limits);
    if (starts_with(file, "\xFF\xD8\xFF"))
        return probe_jpeg(file, limits);
    if (starts_with(file, "RIFF") && starts_with(file, "WEBP", 8))
        return probe_webp(file, limits);
    if (starts_with(file, "\x76\x2f\x31\x01"))
        return probe_exr(file, limits);
    if (starts_with(file, "#?RADIANCE\n") || starts_with(file, "#?RGBE\n"))
        return probe_radiance(file, limits);
    if (starts_with(file, std::string_view("II*\0", 4)) || starts_with(file, std::string_view("MM\0*", 4)))
        return probe_tiff(file, limits);
    if (is_pnm(file))
        return probe_pnm(file, limits);
    if (starts_with(file, "BM"))
        return probe_bmp(file, limits);
    return file.error("byte 0", "not an image of a known format (PNG, JPEG, WebP, OpenEXR, Radiance, TIFF, PNM, BMP)");
}

} // namespace burnish
