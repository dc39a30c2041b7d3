// The module that holds OpenImageIO; no other file uses it. Decodes files from memory and encodes files into memory.
// The module links nothing from the program: it uses only the program's inline functions.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include <fmt/format.h>

#include "core/image/io/image_library.h"

namespace burnish {
namespace {

using Bytes = std::vector<std::uint8_t>;

// CIE xy of red, green, blue and the D65 white in Rec. ITU-R BT.709.
constexpr float kRec709[8] = {0.640f, 0.330f, 0.300f, 0.600f, 0.150f, 0.060f, 0.3127f, 0.3290f};
constexpr int kJpegQuality = 95;

// One thread for each image: burnish reads several images at once instead, and time and memory stay predictable.
constexpr int kThreads = 1;

// Sets the library's process-wide attributes once.
void configure_openimageio()
{
    static const bool done = [] {
        // The attribute "threads" would start the library's pool with a thread for each core. Each image sets its own
        // count instead.
        OIIO::attribute("exr_threads", -1);
        // The C++ reader stops at the first error. The core reader carries on with parts of damaged headers.
        OIIO::attribute("openexr:core", 0);
        // Debian's build would print developer notes on stderr.
        OIIO::attribute("debug", 0);
        return true;
    }();
    static_cast<void>(done);
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
    return type == PixelType::u8 ? OIIO::TypeDesc::UINT8 : type == PixelType::u16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::FLOAT;
}

// Reads from memory and tracks the farthest position, which is the place of an error.
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
    // Bounds the offsets, which come from the file: IOMemReader adds sizes to them unchecked, and would read before the
    // bytes.
    bool seek(int64_t offset) override { return is_inside(offset) && IOMemReader::seek(offset); }
    size_t pread(void* to, size_t size, int64_t offset) override
    {
        if (!is_inside(offset))
            return 0;
        const size_t n = IOMemReader::pread(to, size, offset);
        reached_ = std::max(reached_, static_cast<std::size_t>(offset) + n);
        return n;
    }
    std::string place() const { return own_bytes_ ? fmt::format("byte {}", reached_) : "pixels"; }

  private:
    TrackingReader(const std::uint8_t* data, std::size_t size) : IOMemReader(const_cast<std::uint8_t*>(data), size) {}

    bool is_inside(int64_t offset) const { return offset >= 0 && static_cast<std::size_t>(offset) <= size(); }

    bool own_bytes_ = true;
    std::size_t reached_ = 0;
};

Error library_error(const ImageBytes& file, const std::string& place, const char* what, const std::string& message)
{
    const std::string reason = first_line(message);
    // OpenEXR and OpenImageIO catch operator new's exceptions and pass on their text.
    for (const char* words : {"bad_alloc", "out of memory", "Out of memory", "not enough memory", "Insufficient memory", "allocate"})
        if (reason.find(words) != std::string::npos)
            return file.error("", "not enough memory for the pixels");
    return file.error(place, reason.empty() ? std::string(what) : fmt::format("{}: {}", what, reason));
}

StoredHeader header_of(const OIIO::ImageSpec& spec)
{
    return {spec.width,        spec.height,         spec.depth,      spec.x,           spec.y,
            spec.full_x,       spec.full_y,         spec.full_width, spec.full_height, spec.nchannels,
            spec.channelnames, pixel_type_of(spec), spec.deep};
}

Status read(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place)
{
    configure_openimageio();
    TrackingReader reader(file, probe);
    OIIO::Filesystem::IOProxy* proxy = &reader;
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    config.attribute("oiio:UnassociatedAlpha", 1); // colours stay as stored, without multiplication by alpha
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(probe.format);
    if (!input)
        return library_error(file, "", "the image library cannot read this format", OIIO::geterror());
    input->threads(kThreads);
    if (!input->open("input", spec, config))
        return library_error(file, reader.place(), "the header is damaged", input->geterror());
    if (!input->seek_subimage(probe.subimage, 0))
        return library_error(file, reader.place(), "the image is missing", input->geterror());
    const StoredHeader header = header_of(input->spec());
    const Result<PixelRequest> wanted = place(header);
    BN_TRY(wanted);
    if (!input->read_image(probe.subimage, 0, wanted->first, wanted->end, type_desc_of(header.type), wanted->to))
        return library_error(file, reader.place(), "the pixels are damaged or cut off", input->geterror());
    input->close();
    return {};
}

// Only the image's size, channels and type count.
OIIO::ImageSpec spec_of(const Image& image, const char* format, const std::vector<std::string>& channels)
{
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type_desc_of(image.type));
    // A date with the wrong type: the library then neither adds the present time nor writes this date.
    spec.attribute("DateTime", 0);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (image.type == PixelType::f32) {
        static const char* const kGray[] = {"Y", "A"};
        static const char* const kColour[] = {"R", "G", "B", "A"};
        const char* const* names = image.channels <= 2 ? kGray : kColour;
        spec.channelnames = channels;
        if (channels.empty())
            spec.channelnames.assign(names, names + image.channels);
        const auto alpha = std::find(spec.channelnames.begin(), spec.channelnames.end(), "A");
        spec.alpha_channel = alpha == spec.channelnames.end() ? -1 : static_cast<int>(alpha - spec.channelnames.begin());
        spec.attribute("compression", "zip");
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kRec709);
    } else {
        spec.attribute("oiio:ColorSpace", "sRGB");
        if (std::strcmp(format, "jpeg") == 0)
            spec.attribute("compression", fmt::format("jpeg:{}", kJpegQuality));
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    return spec;
}

std::uint64_t number_at(const Bytes& file, std::size_t at, std::size_t size)
{
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size && at + i < file.size(); ++i)
        value |= static_cast<std::uint64_t>(file[at + i]) << 8 * i;
    return value;
}

// Returns where an OpenEXR file's table of chunks begins.
std::size_t chunk_table(const Bytes& file)
{
    const auto after_word = [&](std::size_t at) {
        while (at < file.size() && file[at] != 0)
            ++at;
        return at + 1;
    };
    std::size_t at = 8;                         // after magic and version
    while (at < file.size() && file[at] != 0) { // an attribute: name, type, size, value
        at = after_word(after_word(at));
        at += 4 + static_cast<std::size_t>(number_at(file, at, 4));
    }
    return at + 1;
}

// Returns true where an OpenEXR file has all its chunks. Each chunk begins with its place (one number or four) and its
// size. With too little memory, the library silently leaves chunks out.
bool has_all_chunks(const Bytes& file, std::size_t chunks, std::size_t place_bytes)
{
    const std::size_t table = chunk_table(file), head = place_bytes + 4;
    for (std::size_t i = 0; i < chunks; ++i) {
        const std::uint64_t begin = number_at(file, table + 8 * i, 8);
        if (begin < table + 8 * chunks || begin + head > file.size() ||
            begin + head + number_at(file, begin + place_bytes, 4) > file.size())
            return false;
    }
    return true;
}

// Does the same for a file that memory does not hold. Reads the size of the last chunk alone.
bool file_has_all_chunks(const std::string& place, std::size_t chunks, std::size_t place_bytes)
{
    constexpr std::size_t kMostHeader = 1u << 20;
    std::ifstream file(place, std::ios::binary | std::ios::ate);
    const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(file.tellg(), 0));
    Bytes head(static_cast<std::size_t>(std::min<std::uint64_t>(size, kMostHeader + 8 * chunks)));
    file.seekg(0);
    if (!file.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size())))
        return false;
    const std::size_t table = chunk_table(head);
    std::uint64_t last = 0;
    for (std::size_t i = 0; i < chunks; ++i) {
        const std::uint64_t begin = number_at(head, table + 8 * i, 8);
        if (begin < table + 8 * chunks || begin + place_bytes + 4 > size)
            return false;
        last = std::max(last, begin);
    }
    Bytes bytes(4);
    file.seekg(static_cast<std::streamoff>(last + place_bytes));
    return file.read(reinterpret_cast<char*>(bytes.data()), 4) && last + place_bytes + 4 + number_at(bytes, 0, 4) <= size;
}

std::size_t parts_of(int size, int part)
{
    return static_cast<std::size_t>((size + part - 1) / part);
}

class OpenExrRows final : public RowWriter {
  public:
    explicit OpenExrRows(std::string path) : path_(std::move(path)) {}
    Status open(const std::string& place, const StreamedPicture& picture)
    {
        configure_openimageio();
        output_ = OIIO::ImageOutput::create("openexr");
        if (!output_)
            return error(OIIO::geterror());
        output_->threads(kThreads);
        Image shape;
        shape.width = picture.width, shape.height = picture.height, shape.channels = picture.channels, shape.type = PixelType::f32;
        spec_ = spec_of(shape, "openexr", picture.channel_names);
        place_ = place, tile_ = picture.tile;
        if (tile_ > 0)
            spec_.tile_width = spec_.tile_height = tile_, spec_.tile_depth = 1;
        return output_->open(place, spec_) ? Status() : error(output_->geterror());
    }
    Status add(const Image& rows) override
    {
        const int begin = next_, end = next_ + rows.height;
        next_ = end;
        errno = 0;
        const bool written = tile_ > 0 ? output_->write_tiles(0, spec_.width, begin, end, 0, 1, OIIO::TypeDesc::FLOAT, rows.bytes.data())
                                       : output_->write_scanlines(begin, end, 0, OIIO::TypeDesc::FLOAT, rows.bytes.data());
        return written ? Status() : error(output_->geterror());
    }
    Status finish() override
    {
        constexpr int kRowsOfChunk = 16; // of ZIP
        errno = 0;
        if (!output_->close())
            return error(output_->geterror());
        output_.reset();
        const std::size_t chunks =
            tile_ > 0 ? parts_of(spec_.width, tile_) * parts_of(spec_.height, tile_) : parts_of(spec_.height, kRowsOfChunk);
        return file_has_all_chunks(place_, chunks, tile_ > 0 ? 16 : 4) ? Status() : error("not all rows were written");
    }

  private:
    Error error(const std::string& message) const
    {
        for (const int code : {ENOSPC, EFBIG, EDQUOT, EIO})
            if (errno == code) // the library's message names the file by its place
                return {ExitCode::output_failed, path_, "", fmt::format("cannot be written: {}", std::strerror(code))};
        return {ExitCode::output_failed, path_, "", "the image cannot be encoded: " + first_line(message)};
    }

    std::string path_, place_;
    std::unique_ptr<OIIO::ImageOutput> output_;
    OIIO::ImageSpec spec_;
    int tile_ = 0, next_ = 0;
};

Result<std::unique_ptr<RowWriter>> write_rows(const std::string& path, const std::string& place, const StreamedPicture& picture)
{
    auto rows = std::make_unique<OpenExrRows>(path);
    BN_TRY(rows->open(place, picture));
    return std::unique_ptr<RowWriter>(std::move(rows));
}

// Ends the library's writing where its argument, a stop token, says so.
bool ends(void* stop, float)
{
    return static_cast<const std::stop_token*>(stop)->stop_requested();
}

Result<Bytes> encode(const std::string& path, const Image& image, const char* format, const std::vector<std::string>& channels,
                     const std::stop_token& stop)
{
    const auto error = [&](const char* what, const std::string& message) {
        return Error{ExitCode::output_failed, path, "", fmt::format("{}: {}", what, first_line(message))};
    };
    configure_openimageio();
    Bytes bytes;
    OIIO::Filesystem::IOVecOutput writer(bytes);
    OIIO::Filesystem::IOProxy* proxy = &writer;
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output)
        return error("the image library cannot write this format", OIIO::geterror());
    output->threads(kThreads);
    OIIO::ImageSpec spec = spec_of(image, format, channels);
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    std::stop_token ended = stop;
    if (!output->open(path, spec) ||
        !output->write_image(spec.format, image.bytes.data(), OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride, ends, &ended) ||
        !output->close())
        return error("the image cannot be encoded", output->geterror());
    if (stop.stop_requested())
        return error("the image cannot be encoded", "stopped");
    if (std::strcmp(format, "openexr") == 0 && !has_all_chunks(bytes, (static_cast<std::size_t>(image.height) + 15) / 16, 4))
        return error("the image cannot be encoded", "not all rows were written");
    return bytes;
}

Result<Bytes> encode_levels(const std::string& path, const std::vector<Image>& levels)
{
    constexpr int kTile = 64;
    const auto error = [&](const std::string& message) {
        return Error{ExitCode::output_failed, path, "", "the levels cannot be encoded: " + first_line(message)};
    };
    configure_openimageio();
    Bytes bytes;
    OIIO::Filesystem::IOVecOutput writer(bytes);
    OIIO::Filesystem::IOProxy* proxy = &writer;
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("openexr");
    if (!output)
        return error(OIIO::geterror());
    output->threads(kThreads);
    std::size_t tiles = 0;
    for (std::size_t l = 0; l < levels.size(); ++l) {
        OIIO::ImageSpec spec = spec_of(levels[l], "openexr", {});
        spec.set_format(OIIO::TypeDesc::HALF);
        spec.tile_width = spec.tile_height = kTile, spec.tile_depth = 1;
        spec.attribute("textureformat", "Plain Texture");
        spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
        if (!output->open(path, spec, l == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendMIPLevel) ||
            !output->write_image(OIIO::TypeDesc::FLOAT, levels[l].bytes.data()))
            return error(output->geterror());
        tiles += static_cast<std::size_t>((spec.width + kTile - 1) / kTile) * static_cast<std::size_t>((spec.height + kTile - 1) / kTile);
    }
    if (!output->close())
        return error(output->geterror());
    output.reset(); // closes the file; a file with levels stays open, without its chunk table, until then
    if (!has_all_chunks(bytes, tiles, 16))
        return error("not all tiles were written");
    return bytes;
}

} // namespace
} // namespace burnish

extern "C" __attribute__((visibility("default"))) const burnish::ImageLibrary* burnish_image_library();
extern "C" const burnish::ImageLibrary* burnish_image_library()
{
    static const burnish::ImageLibrary library = {burnish::read, burnish::encode, burnish::encode_levels, burnish::write_rows};
    return &library;
}
