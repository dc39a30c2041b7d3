// Reading: the bytes are loaded, guarded by our own look at the header, and decoded by OpenImageIO from
// memory.
#include "core/image/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include <fmt/format.h>

#include "core/base/file.h"
#include "core/image/guard.h"
#include "core/image/openimageio.h"

namespace burnish {
namespace {

constexpr int kMaxChannels = 1024;

// The wanted channels of a file, as indices into the file's channels; count 0 where there are none.
struct Selection {
    int count = 0;
    int channels[4] = {0, 0, 0, 0};
    int first() const { return *std::min_element(channels, channels + count); }
    int end() const { return *std::max_element(channels, channels + count) + 1; }
};

int find_channel(const OIIO::ImageSpec& spec, const char* name)
{
    const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
    return found == spec.channelnames.end() ? -1 : static_cast<int>(found - spec.channelnames.begin());
}

Selection take(std::initializer_list<int> channels)
{
    Selection s;
    for (int c : channels)
        if (c >= 0)
            s.channels[s.count++] = c;
    return s;
}

Selection select_channels(const OIIO::ImageSpec& spec)
{
    const int r = find_channel(spec, "R"), g = find_channel(spec, "G"), b = find_channel(spec, "B");
    const int y = find_channel(spec, "Y"), a = find_channel(spec, "A");
    if (r >= 0 && g >= 0 && b >= 0)
        return take({r, g, b, a});
    if (y >= 0)
        return take({y, a});
    Selection s;
    s.count = spec.nchannels <= 4 ? spec.nchannels : 3;
    for (int c = 0; c < s.count; ++c)
        s.channels[c] = c;
    return s;
}

PixelType pixel_type_of(const OIIO::ImageSpec& spec)
{
    if (spec.format == OIIO::TypeDesc::UINT8)
        return PixelType::u8;
    if (spec.format == OIIO::TypeDesc::UINT16)
        return PixelType::u16;
    return PixelType::f32;
}

OIIO::TypeDesc type_desc_of(PixelType type)
{
    return type == PixelType::u8    ? OIIO::TypeDesc::UINT8
           : type == PixelType::u16 ? OIIO::TypeDesc::UINT16
                                    : OIIO::TypeDesc::FLOAT;
}

// Reads from memory and remembers how far the library came, which is where it stumbled.
class TrackingReader : public OIIO::Filesystem::IOMemReader {
  public:
    TrackingReader(const ImageBytes& file, const ImageProbe& probe)
        : TrackingReader(probe.replacement.empty() ? file.data : probe.replacement.data(),
                         probe.replacement.empty() ? file.size : probe.replacement.size())
    {
        own_bytes_ = probe.replacement.empty();
    }
    size_t read(void* to, size_t size) override
    {
        const size_t n = IOMemReader::read(to, size);
        reached_ = std::max(reached_, static_cast<std::size_t>(tell()));
        return n;
    }
    size_t pread(void* to, size_t size, int64_t offset) override
    {
        const size_t n = IOMemReader::pread(to, size, offset);
        reached_ = std::max(reached_, static_cast<std::size_t>(offset) + n);
        return n;
    }
    std::string place() const { return own_bytes_ ? fmt::format("byte {}", reached_) : "pixels"; }

  private:
    TrackingReader(const std::uint8_t* data, std::size_t size)
        : IOMemReader(const_cast<std::uint8_t*>(data), size)
    {
    }

    bool own_bytes_ = true;
    std::size_t reached_ = 0;
};

Error library_error(const ImageBytes& file, const std::string& place, const char* what,
                    const std::string& message)
{
    const std::string reason = first_line(message);
    return file.error(place, reason.empty() ? std::string(what) : fmt::format("{}: {}", what, reason));
}

// Keeps the selected ones of `stride` interleaved channels; `first` is the file's channel that comes first in
// `from`.
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

// Copies the data window into an image of the display window; outside it is zero.
Image place_in_display(Image&& data, const OIIO::ImageSpec& spec)
{
    if (spec.x == spec.full_x && spec.y == spec.full_y && spec.width == spec.full_width &&
        spec.height == spec.full_height)
        return std::move(data);
    Image display = make_image(spec.full_width, spec.full_height, data.channels, data.type);
    const std::size_t pixel = pixel_type_bytes(data.type) * static_cast<std::size_t>(data.channels);
    const int x0 = std::max(spec.x, spec.full_x);
    const int x1 = std::min(spec.x + spec.width, spec.full_x + spec.full_width);
    const int y0 = std::max(spec.y, spec.full_y);
    const int y1 = std::min(spec.y + spec.height, spec.full_y + spec.full_height);
    const auto offset = [&](int x, int y, int width) {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               pixel;
    };
    for (int y = y0; y < y1 && x0 < x1; ++y)
        std::memcpy(display.bytes.data() + offset(x0 - spec.full_x, y - spec.full_y, spec.full_width),
                    data.bytes.data() + offset(x0 - spec.x, y - spec.y, spec.width),
                    static_cast<std::size_t>(x1 - x0) * pixel);
    return display;
}

// Puts the scanlines of a Radiance file in order. `stored` has the file's first axis as rows.
Image orient(Image&& stored, const ImageProbe& probe)
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
            std::memcpy(to,
                        stored.bytes.data() + (row * static_cast<std::size_t>(stored.width) + column) * pixel,
                        pixel);
        }
    return out;
}

// What the library made of the header must fit the limits too.
Status check_spec(const ImageBytes& file, const OIIO::ImageSpec& spec, const Limits& limits)
{
    if (spec.deep)
        return file.error("header", "deep images are not supported");
    if (spec.depth > 1)
        return file.error("header", "volume images are not supported");
    if (spec.nchannels < 1 || spec.nchannels > kMaxChannels)
        return file.error("header", fmt::format("{} channels", spec.nchannels));
    return check_sides(file, spec.width, spec.height, limits);
}

Result<Image> read_pixels(OIIO::ImageInput& input, const TrackingReader& reader, const ImageProbe& probe,
                          const ImageBytes& file, const Limits& limits)
{
    const OIIO::ImageSpec spec = input.spec();
    if (const Status status = check_spec(file, spec, limits); !status)
        return status.error();
    const Selection selection = select_channels(spec);
    const int first = selection.first();
    const int end = selection.end();
    const PixelType type = pixel_type_of(spec);
    const std::uint64_t bytes = static_cast<std::uint64_t>(spec.width) *
                                static_cast<std::uint64_t>(spec.height) *
                                static_cast<std::uint64_t>(end - first) * pixel_type_bytes(type);
    if (bytes > limits.texture_bytes)
        return file.error(
            fmt::format("header: {} x {} pixels", spec.width, spec.height),
            fmt::format("{} bytes of pixels are more than the limit of {}", bytes, limits.texture_bytes));
    Image image = make_image(spec.width, spec.height, end - first, type);
    if (!input.read_image(probe.subimage, 0, first, end, type_desc_of(type), image.bytes.data()))
        return library_error(file, reader.place(), "the pixels are damaged or cut off", input.geterror());
    image = pick_channels(std::move(image), selection, first);
    // Only OpenEXR's windows mean what ours do: other formats' offsets are page layout.
    if (std::strcmp(probe.format, "openexr") == 0)
        image = place_in_display(std::move(image), spec);
    return orient(std::move(image), probe);
}

Result<Image> decode(const ImageBytes& file, const ImageProbe& probe, const Limits& limits)
{
    configure_openimageio();
    TrackingReader reader(file, probe);
    OIIO::Filesystem::IOProxy* proxy = &reader;
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    config.attribute("oiio:UnassociatedAlpha", 1); // colours stay as stored, not multiplied by alpha
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(probe.format);
    if (!input)
        return library_error(file, "", "the image library cannot read this format", OIIO::geterror());
    if (!input->open("input", spec, config))
        return library_error(file, reader.place(), "the header is damaged", input->geterror());
    if (!input->seek_subimage(probe.subimage, 0))
        return library_error(file, reader.place(), "the image is missing", input->geterror());
    Result<Image> image = read_pixels(*input, reader, probe, file, limits);
    input->close();
    return image;
}

} // namespace

std::string first_line(const std::string& text)
{
    std::string line = text.substr(0, text.find_first_of("\r\n"));
    while (!line.empty() && (line.back() == ' ' || line.back() == '.'))
        line.pop_back();
    return line;
}

void configure_openimageio()
{
    static const bool done = [] {
        // One thread an image: burnish reads several images at once instead, and time and memory stay
        // predictable.
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", -1);
        // The C++ reader stops at the first error; the core reader carries on with parts of damaged headers.
        OIIO::attribute("openexr:core", 0);
        // Debian's build prints notes for its own developers on stderr otherwise.
        OIIO::attribute("debug", 0);
        return true;
    }();
    static_cast<void>(done);
}

Result<Image> decode_image(const std::uint8_t* data, std::size_t size, const std::string& label,
                           const Limits& limits)
{
    const ImageBytes file{data, size, label};
    if (size == 0)
        return file.error("", "the image is empty");
    if (size > limits.file_bytes)
        return file.error("", fmt::format("{} bytes, more than the limit of {}", size, limits.file_bytes));
    const Result<ImageProbe> probe = probe_image(file, limits);
    if (!probe)
        return probe.error();
    try {
        return decode(file, *probe, limits);
    } catch (const std::bad_alloc&) {
        return file.error("", "not enough memory for the pixels");
    } catch (const std::exception& exception) {
        return library_error(file, "", "the image is damaged", exception.what());
    }
}

Result<Image> read_image(const std::string& path, const Limits& limits)
{
    const Result<std::vector<std::uint8_t>> bytes = read_file(path, limits.file_bytes);
    if (!bytes)
        return bytes.error();
    return decode_image(bytes->data(), bytes->size(), path, limits);
}

} // namespace burnish
