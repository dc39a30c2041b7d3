// Guards OpenEXR headers (openexr.com, "OpenEXR File Layout") before the library runs. Walks every attribute inside the
// file's bounds, and bounds the library's allocations (offset tables, tiles, scanline blocks).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/image/io/guard.h"

namespace burnish {
namespace {

constexpr std::uint32_t kTiled = 0x200, kDeep = 0x800, kMultiPart = 0x1000;
constexpr int kMaxParts = 256;
constexpr std::size_t kMaxNameBytes = 255;
// The library decodes one tile or scanline block at a time. 256 lines with 16384 RGBA floats take 64 MiB.
constexpr std::uint64_t kMaxBlockBytes = 512ull << 20;
// Scanlines in a block, indexed by the compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::uint64_t kLinesPerBlock[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

struct Window {
    std::int64_t x0 = 0, y0 = 0, x1 = -1, y1 = -1; // inclusive, as stored
    std::int64_t width() const { return x1 - x0 + 1; }
    std::int64_t height() const { return y1 - y0 + 1; }
};

struct Part {
    bool has_channels = false, has_data_window = false, has_display_window = false, has_compression = false;
    bool has_tiles = false, has_type = false, deep = false;
    int channels = 0;
    std::uint64_t pixel_bytes = 0; // all channels
    Window data, display;
    unsigned compression = 0;
    std::uint64_t tile_width = 0, tile_height = 0;
    bool tiled = false;
    std::optional<Primaries> chromaticities;
    std::optional<std::array<double, 2>> neutral; // xy, adoptedNeutral
    std::string colour_space;                     // some writers give a name
    bool cube_faces = false, bad_chromaticities = false, bad_envmap = false;
};

class Reader {
  public:
    explicit Reader(const ImageBytes& file) : file_(file) {}
    std::size_t at() const { return at_; }
    std::size_t left() const { return file_.size - at_; }
    bool skip(std::size_t n)
    {
        if (n > left())
            return false;
        at_ += n;
        return true;
    }
    // Reads a little-endian word. Callers have checked left().
    std::uint32_t u32()
    {
        const std::uint8_t* p = file_.data + at_;
        at_ += 4;
        return p[0] | static_cast<std::uint32_t>(p[1]) << 8 | static_cast<std::uint32_t>(p[2]) << 16 |
               static_cast<std::uint32_t>(p[3]) << 24;
    }
    std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
    double f32() { return static_cast<double>(std::bit_cast<float>(u32())); }
    std::uint8_t u8() { return file_.data[at_++]; }
    // Reads a string and its terminating null. Returns false where the string is too long for a name or the file ends.
    bool name(std::string_view& out)
    {
        const std::size_t most = std::min(left(), kMaxNameBytes + 1);
        const void* end = std::memchr(file_.data + at_, 0, most);
        if (!end)
            return false;
        const char* begin = reinterpret_cast<const char*>(file_.data + at_);
        out = std::string_view(begin, static_cast<std::size_t>(static_cast<const char*>(end) - begin));
        at_ += out.size() + 1;
        return true;
    }
    std::string_view view(std::size_t n) const { return {reinterpret_cast<const char*>(file_.data + at_), n}; }
    Error error(const std::string& reason) const { return file_.error(fmt::format("byte {}", at_), reason); }

  private:
    const ImageBytes& file_;
    std::size_t at_ = 0;
};

Status read_channels(Reader reader, std::size_t size, Part& part)
{
    const std::size_t end = reader.at() + size;
    for (std::string_view name;;) {
        if (!reader.name(name) || reader.at() > end)
            return reader.error("the channel list has no end");
        if (name.empty())
            break;
        if (reader.at() + 16 > end)
            return reader.error("the channel list is cut off");
        const std::uint32_t type = reader.u32();
        reader.skip(4); // the linearity hint and three reserved bytes
        const std::int32_t x_sampling = reader.i32();
        const std::int32_t y_sampling = reader.i32();
        if (type > 2)
            return reader.error(fmt::format("a channel of the unknown type {}", type));
        if (x_sampling != 1 || y_sampling != 1)
            return reader.error(fmt::format("the channel {} is subsampled, which is not supported", name));
        if (++part.channels > kMaxChannels)
            return reader.error(fmt::format("more than {} channels", kMaxChannels));
        part.pixel_bytes += type == 1 ? 2 : 4; // types: 0 uint, 1 half, 2 float
    }
    if (part.channels == 0)
        return reader.error("the channel list is empty");
    part.has_channels = true;
    return {};
}

Window read_window(Reader reader)
{
    Window w;
    w.x0 = reader.i32();
    w.y0 = reader.i32();
    w.x1 = reader.i32();
    w.y1 = reader.i32();
    return w;
}

// Reads the file's colour space and its shape as an environment map. Ignores the standard attribute whiteLuminance: it
// is the unit of radiance, and burnish's radiance has no unit.
void read_colour_attribute(Reader reader, std::string_view name, std::string_view type, std::size_t size, Part& part)
{
    if (name == "chromaticities") {
        part.bad_chromaticities = type != "chromaticities" || size != 32;
        if (part.bad_chromaticities)
            return;
        Primaries primaries;
        for (double& value : primaries)
            value = reader.f32();
        part.chromaticities = primaries;
    } else if (name == "adoptedNeutral" && type == "v2f" && size == 8) {
        const double x = reader.f32(), y = reader.f32();
        part.neutral = {x, y};
    } else if ((name == "colorInteropID" || name == "oiio:ColorSpace") && type == "string") {
        part.colour_space = reader.view(std::min(size, kMaxNameBytes));
    } else if (name == "envmap") {
        const unsigned shape = type == "envmap" && size == 1 ? reader.u8() : 2u; // 0: latitude-longitude, 1: cube
        part.cube_faces = shape == 1, part.bad_envmap = shape > 1;
    }
}

// Returns true for the names that writers give to linear Rec.709.
bool is_linear_rec709(std::string_view name)
{
    constexpr std::string_view kNames[] = {"",
                                           "linear",
                                           "lin_rec709",
                                           "lin_rec709_scene",
                                           "lin_srgb",
                                           "lin_rec709_display",
                                           "Rec709 (linear)",
                                           "Linear Rec.709",
                                           "scene_linear",
                                           "Linear Rec.709 (sRGB)"};
    return std::any_of(std::begin(kNames), std::end(kNames), [&](std::string_view known) {
        return known.size() == name.size() &&
               std::equal(known.begin(), known.end(), name.begin(), [](char a, char b) { return (a | 32) == (b | 32); });
    });
}

StoredColour colour_of(const Part& part)
{
    StoredColour colour;
    if (part.bad_chromaticities)
        colour.warnings.push_back("the attribute chromaticities has the wrong type or size; its colours are taken as Rec.709");
    if (part.chromaticities && !is_rec709(*part.chromaticities))
        colour.primaries = part.chromaticities;
    if (!part.chromaticities && !is_linear_rec709(part.colour_space))
        colour.warnings.push_back(fmt::format(
            "its colour space is named '{}' and no chromaticities are given; its colours are taken as Rec.709", part.colour_space));
    const Primaries primaries = part.chromaticities.value_or(kRec709Primaries);
    constexpr double kRounded = 5e-4;
    if (part.neutral &&
        !(std::fabs((*part.neutral)[0] - primaries[6]) < kRounded && std::fabs((*part.neutral)[1] - primaries[7]) < kRounded))
        colour.warnings.push_back(fmt::format("its adoptedNeutral ({:g}, {:g}) is not the white of its chromaticities; it is not used",
                                              (*part.neutral)[0], (*part.neutral)[1]));
    if (part.bad_envmap)
        colour.warnings.push_back("the attribute envmap names no known shape; it is taken as latlong");
    return colour;
}

Status read_attribute(Reader reader, std::string_view name, std::string_view type, std::size_t size, Part& part)
{
    const auto is = [&](std::string_view n, std::string_view t, std::size_t bytes) { return name == n && type == t && size == bytes; };
    if (name == "channels" && type == "chlist")
        return read_channels(reader, size, part);
    if (is("dataWindow", "box2i", 16)) {
        part.data = read_window(reader);
        part.has_data_window = true;
    } else if (is("displayWindow", "box2i", 16)) {
        part.display = read_window(reader);
        part.has_display_window = true;
    } else if (is("compression", "compression", 1)) {
        part.compression = reader.u8();
        part.has_compression = true;
    } else if (is("tiles", "tiledesc", 9)) {
        part.tile_width = reader.u32();
        part.tile_height = reader.u32();
        part.has_tiles = true;
    } else if (name == "type" && type == "string") {
        const std::string_view value = reader.view(size);
        part.has_type = true;
        part.deep = value == "deepscanline" || value == "deeptile";
        part.tiled = value == "tiledimage";
        if (!part.deep && !part.tiled && value != "scanlineimage")
            return reader.error("a part of an unknown type");
    } else if (name == "dataWindow" || name == "displayWindow" || name == "compression" || name == "tiles" || name == "channels" ||
               name == "type") {
        return reader.error(fmt::format("the attribute {} has the wrong type or size", name));
    } else {
        read_colour_attribute(reader, name, type, size, part);
    }
    return {};
}

// Reads one header up to and including its end mark. `any` stays false for a header that is only the end mark.
Status read_part(Reader& reader, Part& part, bool& any)
{
    for (;;) {
        std::string_view name, type;
        if (!reader.name(name))
            return reader.error("an attribute name without an end");
        if (name.empty())
            return {};
        any = true;
        if (!reader.name(type) || type.empty())
            return reader.error("an attribute without a type");
        if (reader.left() < 4)
            return reader.error("the header is cut off");
        const std::size_t size = reader.u32();
        if (size > reader.left())
            return reader.error(fmt::format("an attribute of {} bytes does not fit into the file", size));
        BN_TRY(read_attribute(reader, name, type, size, part));
        reader.skip(size);
    }
}

Status check_part(const ImageBytes& file, const Part& part, const Limits& limits, std::uint64_t& offsets)
{
    // Check that the required attributes are present
    if (!part.has_channels || !part.has_data_window || !part.has_display_window || !part.has_compression)
        return file.error("header", "channels, windows or compression are missing");
    if (part.compression >= std::size(kLinesPerBlock))
        return file.error("header: compression", fmt::format("unknown method {}", part.compression));
    // Check both windows against the limits
    for (const Window* window : {&part.data, &part.display}) {
        constexpr std::int64_t kFar = 1 << 30;
        if (window->x0 < -kFar || window->y0 < -kFar || window->x1 > kFar || window->y1 > kFar)
            return file.error("header", "a window lies absurdly far away");
        BN_TRY(check_sides(file, window->width(), window->height(), limits));
        const std::uint64_t pixel_bytes = 4 * static_cast<std::uint64_t>(std::min(part.channels, 4));
        BN_TRY(
            check_proportion(file, static_cast<std::uint64_t>(window->width()), static_cast<std::uint64_t>(window->height()), pixel_bytes));
    }
    // Check the size of tiles or scanline blocks
    const std::uint64_t width = static_cast<std::uint64_t>(part.data.width());
    const std::uint64_t height = static_cast<std::uint64_t>(part.data.height());
    std::uint64_t block_width = width, block_height = kLinesPerBlock[part.compression];
    if (part.tiled) {
        if (!part.has_tiles || part.tile_width == 0 || part.tile_height == 0)
            return file.error("header: tiles", "a tiled image without a tile size");
        block_width = part.tile_width;
        block_height = part.tile_height;
    }
    if (block_width > kMaxBlockBytes || block_height > kMaxBlockBytes || block_width * block_height * part.pixel_bytes > kMaxBlockBytes)
        return file.error("header: tiles", fmt::format("blocks of {} x {} pixels are too large", block_width, block_height));
    // Count an 8-byte entry in the offset table for each block.
    offsets += ((width + block_width - 1) / block_width) * ((height + block_height - 1) / block_height) * 8;
    if (offsets > file.size)
        return file.error(fmt::format("header: {} x {} pixels", width, height),
                          fmt::format("{} bytes cannot hold that many pixels", file.size));
    return {};
}

} // namespace

Result<ImageProbe> probe_exr(const ImageBytes& file, const Limits& limits)
{
    Reader reader(file);
    if (!reader.skip(4) || reader.left() < 4)
        return reader.error("the file ends inside its header");
    // Check the version and the kind of file
    const std::uint32_t version = reader.u32();
    if ((version & 0xFF) != 2)
        return file.error("byte 4", fmt::format("OpenEXR version {} is unknown", version & 0xFF));
    const bool many = (version & kMultiPart) != 0;
    if (!many && (version & kDeep))
        return file.error("byte 4", "deep images are not supported");
    ImageProbe probe{"openexr", -1};
    std::uint64_t offsets = 0;
    // Check every part, and choose the first flat one
    for (int index = 0; many || index == 0; ++index) {
        if (index == kMaxParts)
            return reader.error(fmt::format("more than {} parts", kMaxParts));
        Part part;
        bool any = false;
        BN_TRY(read_part(reader, part, any));
        if (many && !any)
            break;
        if (!many && (version & kTiled))
            part.tiled = true;
        BN_TRY(check_part(file, part, limits, offsets));
        if (part.deep || probe.subimage >= 0)
            continue;
        probe.subimage = index;
        probe.colour = colour_of(part);
        probe.cube_faces = part.cube_faces;
    }
    if (probe.subimage < 0)
        return file.error("header: type", "the file has no flat part; deep images are not supported");
    return probe;
}

} // namespace burnish
