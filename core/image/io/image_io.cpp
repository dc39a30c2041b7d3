// Reads images: loads the bytes, guards the header, and lets the image library decode from memory.
#include "core/image/io/image_io.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "core/base/exception.h"
#include "core/base/file.h"
#include "core/image/io/common_formats.h"
#include "core/image/io/guard.h"
#include "core/image/io/icc.h"
#include "core/image/io/image_library.h"
#include "core/image/io/inflate.h"
#include "core/image/io/jpeg_watch.h"
#include "core/image/io/radiance.h"

namespace burnish {
namespace {

// Selected channels as indices into the file's channels; count 0 where the file has none.
struct Selection {
    int count = 0;
    int channels[4] = {0, 0, 0, 0};
    bool chroma = false; // Y, RY, BY
    int first() const { return *std::min_element(channels, channels + count); }
    int end() const { return *std::max_element(channels, channels + count) + 1; }
};

int find_channel(const StoredHeader& header, const char* name)
{
    const auto found = std::find(header.channel_names.begin(), header.channel_names.end(), name);
    return found == header.channel_names.end() ? -1 : static_cast<int>(found - header.channel_names.begin());
}

Selection take(std::initializer_list<int> channels)
{
    Selection s;
    for (int c : channels)
        if (c >= 0)
            s.channels[s.count++] = c;
    return s;
}

// Returns the warning about channels with unknown names: how the reader interprets them.
std::string guess_words(const StoredHeader& header, int count)
{
    std::string names;
    for (int c = 0; c < count; ++c)
        names += (c ? ", " : "") + header.channel_names[static_cast<std::size_t>(c)];
    const char* const kTaken[] = {"grey", "grey and alpha", "red, green and blue", "red, green, blue and alpha"};
    return fmt::format("has no channels R, G, B or Y; taken as {}: {}", kTaken[count - 1], names);
}

Result<Selection> select_channels(const ImageBytes& file, const StoredHeader& header, PictureNotes& notes)
{
    const int r = find_channel(header, "R"), g = find_channel(header, "G"), b = find_channel(header, "B");
    const int y = find_channel(header, "Y"), a = find_channel(header, "A");
    const int ry = find_channel(header, "RY"), by = find_channel(header, "BY");
    if (r >= 0 && g >= 0 && b >= 0)
        return take({r, g, b, a});
    if (y >= 0 && find_channel(header, "X") >= 0 && find_channel(header, "Z") >= 0)
        return file.error("header: channels", "X, Y and Z hold CIE colours, which are not supported, only R, G and B");
    if (y >= 0 && (ry >= 0) != (by >= 0))
        return file.error("header: channels", fmt::format("{} without {}", ry >= 0 ? "RY" : "BY", ry >= 0 ? "BY" : "RY"));
    if (y >= 0) {
        Selection s = ry >= 0 ? take({y, ry, by, a}) : take({y, a});
        s.chroma = ry >= 0;
        return s;
    }
    Selection s;
    s.count = header.channels <= 4 ? header.channels : 3;
    for (int c = 0; c < s.count; ++c)
        s.channels[c] = c;
    if (header.channel_names.size() >= static_cast<std::size_t>(s.count) && s.count > 0)
        notes.warnings.push_back(guess_words(header, s.count));
    return s;
}

// Keeps the selected channels. `first` is the file's index of the first channel in `from`.
Image pick_channels(Image&& from, const Selection& selection, int first)
{
    bool all = selection.count == from.channels;
    for (int c = 0; c < selection.count; ++c)
        all = all && selection.channels[c] == first + c;
    if (all)
        return std::move(from);
    Image to = make_image(from.width, from.height, selection.count, from.type);
    const std::size_t sample = pixel_type_bytes(from.type);
    const std::size_t stride = sample * static_cast<std::size_t>(from.channels);
    std::byte* out = to.bytes.data();
    for (const std::byte* in = from.bytes.data(); in != from.bytes.data() + from.bytes.size(); in += stride)
        for (int c = 0; c < selection.count; ++c, out += sample)
            std::memcpy(out, in + sample * static_cast<std::size_t>(selection.channels[c] - first), sample);
    return to;
}

// Copies the data window into an image of the display window. Pixels outside the data window are zero.
Image place_in_display(Image&& data, const StoredHeader& header)
{
    if (header.x == header.full_x && header.y == header.full_y && header.width == header.full_width && header.height == header.full_height)
        return std::move(data);
    Image display = make_image(header.full_width, header.full_height, data.channels, data.type);
    const std::size_t pixel = pixel_type_bytes(data.type) * static_cast<std::size_t>(data.channels);
    const int x0 = std::max(header.x, header.full_x);
    const int x1 = std::min(header.x + header.width, header.full_x + header.full_width);
    const int y0 = std::max(header.y, header.full_y);
    const int y1 = std::min(header.y + header.height, header.full_y + header.full_height);
    const auto offset = [&](int x, int y, int width) {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * pixel;
    };
    for (int y = y0; y < y1 && x0 < x1; ++y)
        std::memcpy(display.bytes.data() + offset(x0 - header.full_x, y - header.full_y, header.full_width),
                    data.bytes.data() + offset(x0 - header.x, y - header.y, header.width), static_cast<std::size_t>(x1 - x0) * pixel);
    return display;
}

// Puts a Radiance file's scanlines in order. The rows of `stored` run along the file's first axis.
Image orient(Image&& stored, const RadianceLayout& probe)
{
    if (!probe.transpose && !probe.flip_x && !probe.flip_y)
        return std::move(stored);
    const int width = probe.transpose ? stored.height : stored.width;
    const int height = probe.transpose ? stored.width : stored.height;
    Image out = make_image(width, height, stored.channels, stored.type);
    const std::size_t pixel = pixel_type_bytes(stored.type) * static_cast<std::size_t>(stored.channels);
    std::byte* to = out.bytes.data();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, to += pixel) {
            const std::size_t from_x = static_cast<std::size_t>(probe.flip_x ? width - 1 - x : x);
            const std::size_t from_y = static_cast<std::size_t>(probe.flip_y ? height - 1 - y : y);
            const std::size_t row = probe.transpose ? from_x : from_y;
            const std::size_t column = probe.transpose ? from_y : from_x;
            std::memcpy(to, stored.bytes.data() + (row * static_cast<std::size_t>(stored.width) + column) * pixel, pixel);
        }
    return out;
}

// Checks the library's own reading of the header against the limits.
Status check_header(const ImageBytes& file, const StoredHeader& header, const Limits& limits)
{
    if (header.deep)
        return file.error("header", "deep images are not supported");
    if (header.depth > 1)
        return file.error("header", "volume images are not supported");
    if (header.channels < 1 || header.channels > kMaxChannels)
        return file.error("header", fmt::format("{} channels", header.channels));
    return check_sides(file, header.width, header.height, limits);
}

// Reads pixels by the format's library, or by the image library. Radiance files need none.
Status read_pixels(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place)
{
    if (std::strcmp(probe.format, "hdr") == 0)
        return read_radiance(file, probe, place);
    std::optional<Status> read;
    if (std::strcmp(probe.format, "png") == 0)
        read = read_png(file, probe, place);
    else if (std::strcmp(probe.format, "jpeg") == 0)
        read = read_jpeg(file, place);
    else if (std::strcmp(probe.format, "webp") == 0)
        read = read_webp(file, place);
#ifdef __EMSCRIPTEN__
    else if (std::strcmp(probe.format, "pnm") == 0)
        read = read_pfm(file, place);
#endif
    if (read)
        return *read;
    const Result<const ImageLibrary*> library = image_library(file.label);
    return library ? (*library)->read(file, probe, place) : Status(library.error());
}

Result<Image> decode(const ImageBytes& file, const ImageProbe& probe, const Limits& limits, const HasRoom& room, PictureNotes& notes)
{
    const bool exr = std::strcmp(probe.format, "openexr") == 0;
    // Only OpenEXR windows place the image: in other formats, offsets are page layout. A cube's faces fill the data
    // window.
    const bool in_display = exr && !probe.cube_faces;
    StoredHeader header;
    Selection selection;
    Image image;
    // Choose the channels, and allocate memory within the limit
    const auto place = [&](const StoredHeader& found) -> Result<PixelRequest> {
        image = {}; // of another library, which gave up
        BN_TRY(check_header(file, found, limits));
        header = found;
        PictureNotes unsaid; // dropped: other formats have no channel names
        const Result<Selection> selected = select_channels(file, header, exr ? notes : unsaid);
        BN_TRY(selected);
        selection = *selected;
        const int first = selection.first();
        const int end = selection.end();
        const auto bytes_of = [&](int width, int height, int channels) {
            return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * static_cast<std::uint64_t>(channels) *
                   pixel_type_bytes(header.type);
        };
        const std::uint64_t bytes = bytes_of(header.width, header.height, end - first);
        const std::uint64_t placed = in_display ? bytes_of(header.full_width, header.full_height, selection.count) : 0;
        if (bytes > limits.texture_bytes)
            return file.error(fmt::format("header: {} x {} pixels", header.width, header.height),
                              fmt::format("{} bytes of pixels are more than the limit of {}", bytes, limits.texture_bytes));
        if (room && !room(std::max(bytes, placed)))
            return file.error("", fmt::format("no room for {} bytes of pixels", std::max(bytes, placed)));
        image = make_image(header.width, header.height, end - first, header.type);
        return PixelRequest{first, end, image.bytes.data()};
    };
    // Decode the pixels, and convert them to colours or data
    BN_TRY(read_pixels(file, probe, place));
    image = pick_channels(std::move(image), selection, selection.first());
    if (selection.chroma)
        decode_luminance_chroma(image, luminance_weights(probe.colour.primaries.value_or(kRec709Primaries)));
    apply_gain(image, probe.colour.gain);
    notes.cube_faces = probe.cube_faces;
    if (in_display)
        image = place_in_display(std::move(image), header);
    return orient(std::move(image), probe.radiance);
}

Result<ImageProbe> probe_bytes(const ImageBytes& file, const Limits& limits)
{
    if (file.size == 0)
        return file.error("", "the image is empty");
    if (file.size > limits.file_bytes)
        return file.error("", fmt::format("{} bytes, more than the limit of {}", file.size, limits.file_bytes));
    return probe_image(file, limits);
}

Result<Image> decode_probed(const ImageBytes& file, const ImageProbe& probe, const Limits& limits, PictureNotes& notes, const HasRoom& room)
{
    try {
        Result<Image> image = decode(file, probe, limits, room, notes);
        if (image && std::strcmp(probe.format, "jpeg") == 0) {
            if (const std::string warning = jpeg_warning(file); !warning.empty())
                notes.warnings.push_back(warning);
            note_jpeg(file, *image);
        }
        return image;
    } catch (...) {
        return error_of_exception(file.error("", "the image is damaged"));
    }
}

// Returns the warning about the colour profile, if any.
std::string warning_of_profile(const StoredColour& colour)
{
    constexpr std::size_t kMostProfile = std::size_t{4} << 20;
    if (colour.profile.empty())
        return "";
    const std::vector<std::uint8_t> profile =
        colour.deflated ? inflated(colour.profile.data(), colour.profile.size(), kMostProfile) : colour.profile;
    return profile_warning(profile.data(), profile.size());
}

} // namespace

Result<Image> decode_image(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits, PictureNotes* notes,
                           const HasRoom& room)
{
    const ImageBytes file{data, size, label};
    const Result<ImageProbe> probe = probe_bytes(file, limits);
    BN_TRY(probe);
    PictureNotes unread;
    return decode_probed(file, *probe, limits, notes ? *notes : unread, room);
}

Result<Image> decode_colours(const std::uint8_t* data, std::size_t size, const std::string& label, const Limits& limits,
                             PictureNotes& notes, const HasRoom& room)
{
    const ImageBytes file{data, size, label};
    const Result<ImageProbe> probe = probe_bytes(file, limits);
    BN_TRY(probe);
    Result<Image> image = decode_probed(file, *probe, limits, notes, room);
    BN_TRY(image);
    const StoredColour& colour = probe->colour;
    notes.warnings.insert(notes.warnings.end(), colour.warnings.begin(), colour.warnings.end());
    if (const std::string warning = warning_of_profile(colour); !warning.empty())
        notes.warnings.push_back(warning);
    if (!colour.primaries || image->type != PixelType::f32 || image->channels < 3)
        return image;
    if (const auto to_rec709 = matrix_to_rec709(*colour.primaries)) {
        apply_matrix(*image, *to_rec709);
        notes.converted = true;
    } else {
        notes.warnings.push_back("its primaries span no colours; its colours are taken as Rec.709");
    }
    return image;
}

Result<Image> read_image(const std::string& path, const Limits& limits, PictureNotes* notes, const HasRoom& room)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, limits.file_bytes);
    BN_TRY(bytes);
    return decode_image(bytes->data(), bytes->size(), path, limits, notes, room);
}

Result<Image> read_colours(const std::string& path, const Limits& limits, PictureNotes& notes, const HasRoom& room)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, limits.file_bytes);
    BN_TRY(bytes);
    return decode_colours(bytes->data(), bytes->size(), path, limits, notes, room);
}

} // namespace burnish
