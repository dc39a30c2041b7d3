// Radiance files (Ward, "Real Pixels", 1991; "picture format" in the reference manual). Text lines and an empty line
// precede the resolution line, such as "-Y 512 +X 1024". Its first axis counts the scanlines. The scanlines follow,
// each plain or run-length coded.
#include "core/image/io/radiance.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/base/check.h"

namespace burnish {
namespace {

constexpr std::string_view kBlanks = " \t\r";

// Parses exactly `count` numbers between blanks; nothing where the text holds anything else.
template <std::size_t count> std::optional<std::array<double, count>> numbers_of(std::string_view text)
{
    std::array<double, count> out{};
    for (double& value : out) {
        text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
        if (text.starts_with("+-"))
            return std::nullopt;
        if (text.starts_with('+'))
            text.remove_prefix(1);
        const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), value);
        if (read.ec != std::errc() || !std::isfinite(value))
            return std::nullopt;
        text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
        if (!text.empty() && kBlanks.find(text[0]) == std::string_view::npos)
            return std::nullopt;
    }
    return text.find_first_not_of(kBlanks) == std::string_view::npos ? std::optional(out) : std::nullopt;
}

bool take_prefix(std::string_view& line, std::string_view prefix)
{
    if (!line.starts_with(prefix))
        return false;
    line.remove_prefix(prefix.size());
    return true;
}

std::string_view trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(kBlanks);
    return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Divides the gain by the factors, which must be numbers above 0.
template <std::size_t count> Status divide_gain(const ImageBytes& file, const char* name, std::string_view text, StoredColour& colour)
{
    const std::optional<std::array<double, count>> factors = numbers_of<count>(text);
    for (std::size_t c = 0; factors && c < 3; ++c)
        colour.gain[c] /= (*factors)[c % count];
    for (const double gain : colour.gain)
        if (!factors || !std::isfinite(gain) || !(gain > 0.0))
            return file.error(fmt::format("header: {}", name),
                              fmt::format("needs {} above 0 that floats hold", count == 1 ? "a number" : "three numbers"));
    return {};
}

void read_primaries(std::string_view text, StoredColour& colour)
{
    const std::optional<Primaries> primaries = numbers_of<8>(text);
    colour.primaries.reset();
    if (!primaries)
        colour.warnings.push_back("the header's PRIMARIES are no eight numbers; its colours are taken as Rec.709");
    else if (!is_rec709(*primaries))
        colour.primaries = *primaries;
}

// Reads a header line. A line that begins with a blank describes a source image, and says nothing about these pixels.
// PIXASPECT is a pixel's shape on paper; code that works with angles or pixels ignores it.
Status read_line(const ImageBytes& file, std::string_view line, StoredColour& colour)
{
    if (take_prefix(line, "FORMAT=")) {
        const std::string_view format = trimmed(line);
        if (format == "32-bit_rle_xyze")
            return file.error("header: FORMAT", "XYZE pixels are not supported, only RGBE");
        if (format != "32-bit_rle_rgbe")
            return file.error("header: FORMAT", "is neither 32-bit_rle_rgbe nor 32-bit_rle_xyze");
    } else if (take_prefix(line, "EXPOSURE=")) {
        return divide_gain<1>(file, "EXPOSURE", line, colour);
    } else if (take_prefix(line, "COLORCORR=")) {
        return divide_gain<3>(file, "COLORCORR", line, colour);
    } else if (take_prefix(line, "PRIMARIES=")) {
        read_primaries(line, colour);
    } else if (take_prefix(line, "GAMMA=")) {
        const std::optional<std::array<double, 1>> gamma = numbers_of<1>(line);
        if (!gamma || (*gamma)[0] != 1.0)
            colour.warnings.push_back("the header's GAMMA is not 1; its pixels are taken as linear");
    }
    return {};
}

Status read_header(const ImageBytes& file, std::string_view header, StoredColour& colour)
{
    while (!header.empty()) {
        const std::size_t end = std::min(header.find('\n'), header.size());
        BN_TRY(read_line(file, header.substr(0, end), colour));
        header.remove_prefix(std::min(end + 1, header.size()));
    }
    return {};
}

struct Resolution {
    std::int64_t sides[2] = {0, 0};
    char axes[2] = {0, 0};
    bool negative[2] = {false, false};
};

// Reads the resolution line at `at` and moves `at` past it.
std::optional<Resolution> read_resolution(std::string_view text, std::size_t& at)
{
    Resolution out;
    for (int i = 0; i < 2; ++i) {
        if (at + 3 > text.size() || (text[at] != '-' && text[at] != '+') || (text[at + 1] != 'X' && text[at + 1] != 'Y') ||
            text[at + 2] != ' ')
            return std::nullopt;
        out.negative[i] = text[at] == '-', out.axes[i] = text[at + 1];
        const std::from_chars_result read = std::from_chars(text.data() + at + 3, text.data() + text.size(), out.sides[i]);
        const std::size_t end = static_cast<std::size_t>(read.ptr - text.data());
        if (read.ec != std::errc() || end >= text.size() || text[end] != (i == 0 ? ' ' : '\n'))
            return std::nullopt;
        at = end + 1;
    }
    return out;
}

// Returns true for the newer coding: 2, 2, the length in two bytes, then the four channels in sequence.
bool begins_new_scanline(const ImageBytes& file, std::size_t at, int pixels)
{
    return pixels >= 8 && pixels <= 0x7FFF && file.size - at >= 4 && file.data[at] == 2 && file.data[at + 1] == 2 &&
           file.data[at + 2] < 128;
}

Status cut_off(const ImageBytes& file)
{
    return file.error(fmt::format("byte {}", file.size), "the pixels are cut off");
}

Status damaged(const ImageBytes& file, std::size_t at, std::uint64_t count)
{
    return file.error(fmt::format("byte {}", at), fmt::format("the pixels are damaged: a run of {} does not fit into its scanline", count));
}

Status read_new_scanline(const ImageBytes& file, std::size_t& at, std::size_t pixels, std::uint8_t* rgbe)
{
    const std::size_t length = static_cast<std::size_t>(file.data[at + 2]) << 8 | file.data[at + 3];
    if (length != pixels)
        return file.error(fmt::format("byte {}", at),
                          fmt::format("the pixels are damaged: a scanline of {} in place of {}", length, pixels));
    at += 4;
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t x = 0; x < pixels;) {
            if (file.size - at < 2)
                return cut_off(file);
            const std::uint8_t code = file.data[at++];
            const std::size_t count = code > 128 ? code - 128u : code;
            if (count == 0 || count > pixels - x)
                return damaged(file, at - 1, count);
            if (code <= 128 && file.size - at < count)
                return cut_off(file);
            for (std::size_t i = 0; i < count; ++i)
                rgbe[4 * (x + i) + channel] = file.data[code > 128 ? at : at + i];
            at += code > 128 ? 1 : count;
            x += count;
        }
    return {};
}

// Reads the older coding, and plain pixels. 1, 1, 1, n repeats the last pixel n times; consecutive repeats are base-256
// digits, lowest first.
Status read_old_scanline(const ImageBytes& file, std::size_t& at, std::size_t pixels, std::uint8_t* rgbe)
{
    unsigned shift = 0;
    for (std::size_t x = 0; x < pixels;) {
        if (file.size - at < 4)
            return cut_off(file);
        const std::uint8_t* pixel = file.data + at;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            std::memcpy(rgbe + 4 * x++, pixel, 4);
            at += 4, shift = 0;
            continue;
        }
        const std::uint64_t count = static_cast<std::uint64_t>(pixel[3]) << std::min(shift, 32u); // a side has 31 bits
        if (x == 0 || count > pixels - x)
            return damaged(file, at, count);
        for (const std::size_t end = x + static_cast<std::size_t>(count); x < end; ++x)
            std::memcpy(rgbe + 4 * x, rgbe + 4 * (x - 1), 4);
        at += 4, shift += shift < 32 ? 8 : 0;
    }
    return {};
}

// Converts to floats without adding half a step: a mantissa of 0 is 0, as in Radiance.
void to_floats(const std::uint8_t* rgbe, std::size_t pixels, float* rgb)
{
    for (std::size_t i = 0; i < pixels; ++i, rgbe += 4, rgb += 3) {
        const float unit = rgbe[3] == 0 ? 0.0f : std::ldexp(1.0f, rgbe[3] - 136);
        for (std::size_t c = 0; c < 3; ++c)
            rgb[c] = static_cast<float>(rgbe[c]) * unit;
    }
}

// Refuses more pixels than the file's bytes can hold. A packet of the newer coding takes 2 bytes for at most 127
// values, four for each pixel. Runs of the older coding may have any length.
Status check_bytes(const ImageBytes& file, const RadianceLayout& layout)
{
    const std::uint64_t width = static_cast<std::uint64_t>(layout.scanline_pixels), height = static_cast<std::uint64_t>(layout.scanlines);
    if (!begins_new_scanline(file, layout.pixels_at, layout.scanline_pixels)) {
        if (4 * height > file.size) // at least a pixel for each scanline
            return file.error(fmt::format("header: {} x {} pixels", width, height),
                              fmt::format("{} bytes cannot hold that many pixels", file.size));
        return check_proportion(file, width, height, 3 * sizeof(float));
    }
    if (width * height * 8 / 127 > file.size)
        return file.error(fmt::format("header: {} x {} pixels", width, height),
                          fmt::format("{} bytes cannot hold that many pixels", file.size));
    return {};
}

} // namespace

Result<ImageProbe> probe_radiance(const ImageBytes& file, const Limits& limits)
{
    const std::string_view text(reinterpret_cast<const char*>(file.data), file.size);
    const std::size_t gap = text.find("\n\n");
    if (gap == std::string_view::npos)
        return file.error(fmt::format("byte {}", file.size), "the Radiance header does not end");
    ImageProbe probe{"hdr"};
    BN_TRY(read_header(file, text.substr(0, gap), probe.colour));
    RadianceLayout& layout = probe.radiance;
    layout.pixels_at = gap + 2;
    const std::optional<Resolution> resolution = read_resolution(text, layout.pixels_at);
    if (!resolution)
        return file.error(fmt::format("byte {}", gap + 2), "a resolution line such as \"-Y 512 +X 1024\" should stand here");
    if (resolution->axes[0] == resolution->axes[1])
        return file.error("header: resolution", "the same axis twice");
    layout.transpose = resolution->axes[0] == 'X';
    const int x = layout.transpose ? 0 : 1;
    BN_TRY(check_sides(file, resolution->sides[x], resolution->sides[1 - x], limits));
    layout.scanlines = static_cast<int>(resolution->sides[0]);
    layout.scanline_pixels = static_cast<int>(resolution->sides[1]);
    // Y points up and X right: "-Y" scanlines go down from the top.
    layout.flip_x = resolution->negative[x], layout.flip_y = !resolution->negative[1 - x];
    BN_TRY(check_bytes(file, layout));
    return probe;
}

Status read_radiance(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place)
{
    const RadianceLayout& layout = probe.radiance;
    StoredHeader header;
    header.width = header.full_width = layout.scanline_pixels;
    header.height = header.full_height = layout.scanlines;
    header.depth = 1, header.channels = 3;
    header.channel_names = {"R", "G", "B"};
    const Result<PixelRequest> wanted = place(header);
    BN_TRY(wanted);
    BN_CHECK(wanted->first == 0 && wanted->end == 3);
    const std::size_t pixels = static_cast<std::size_t>(layout.scanline_pixels);
    std::vector<std::uint8_t> rgbe(4 * pixels);
    float* to = reinterpret_cast<float*>(wanted->to);
    std::size_t at = layout.pixels_at;
    for (int line = 0; line < layout.scanlines; ++line, to += 3 * pixels) {
        const Status read = begins_new_scanline(file, at, layout.scanline_pixels) ? read_new_scanline(file, at, pixels, rgbe.data())
                                                                                  : read_old_scanline(file, at, pixels, rgbe.data());
        BN_TRY(read);
        to_floats(rgbe.data(), pixels, to);
    }
    return {};
}

} // namespace burnish
