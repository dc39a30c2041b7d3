// Replaces png_read.cpp, jpeg_read.cpp and inflate.cpp in WebAssembly, which has neither libpng nor libjpeg. PNG has one right picture.
// JPEG decoders may differ by a step of 255, so pages that promise a hash bring JPEG images decoded by libjpeg, as PNG files in /decoded.
#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/image/io/common_formats.h"
#include "core/image/io/inflate.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_NO_THREAD_LOCALS
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#include <stb/stb_image.h>

namespace burnish {
namespace {

constexpr std::uint64_t kMostDecoded = 1ull << 30; // bytes of a PNG file
using Pixels = std::unique_ptr<void, void (*)(void*)>;

// Decodes grey and colour, with or without alpha, 8 or 16 bits.
std::optional<Status> read_by_stb(const std::uint8_t* data, std::size_t size, const PlacePixels& place)
{
    const int length = static_cast<int>(size);
    StoredHeader header;
    if (size > 0x7fffffff || stbi_info_from_memory(data, length, &header.width, &header.height, &header.channels) == 0)
        return std::nullopt;
    const bool wide = stbi_is_16_bit_from_memory(data, length) != 0;
    int width = 0, height = 0, channels = 0;
    const Pixels pixels(wide ? static_cast<void*>(stbi_load_16_from_memory(data, length, &width, &height, &channels, header.channels))
                             : static_cast<void*>(stbi_load_from_memory(data, length, &width, &height, &channels, header.channels)),
                        stbi_image_free);
    if (!pixels || width != header.width || height != header.height)
        return std::nullopt;
    header.full_width = width, header.full_height = height, header.depth = 1, header.type = wide ? PixelType::u16 : PixelType::u8;
    header.channel_names = header.channels <= 2 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G", "B", "A"};
    header.channel_names.resize(static_cast<std::size_t>(header.channels));
    const Result<PixelRequest> wanted = place(header);
    if (!wanted)
        return Status(wanted.error());
    if (wanted->first != 0 || wanted->end != header.channels)
        return std::nullopt;
    std::memcpy(wanted->to, pixels.get(),
                static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(header.channels) *
                    pixel_type_bytes(header.type));
    return Status();
}

std::string decoded_path(const ImageBytes& file)
{
    return fmt::format("/decoded/{:016x}.png", hash_bytes(file.data, file.size, 0));
}

} // namespace

std::optional<Status> read_png(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place)
{
    const bool own = probe.replacement.empty();
    return read_by_stb(own ? file.data : probe.replacement.data(), own ? file.size : probe.replacement.size(), place);
}

std::optional<Status> read_jpeg(const ImageBytes& file, const PlacePixels& place)
{
    const Result<std::vector<std::uint8_t>> decoded = read_file(decoded_path(file), kMostDecoded);
    return decoded ? read_by_stb(decoded->data(), decoded->size(), place) : read_by_stb(file.data, file.size, place);
}

std::string jpeg_warning(const ImageBytes& file)
{
    return read_file(decoded_path(file), kMostDecoded) ? ""
                                                       : "is a JPEG image: its texels may differ by a step from those of other machines";
}

std::vector<std::uint8_t> inflated(const std::uint8_t* data, std::size_t size, std::size_t most)
{
    std::vector<std::uint8_t> out(most);
    const int length = stbi_zlib_decode_buffer(reinterpret_cast<char*>(out.data()), static_cast<int>(most),
                                               reinterpret_cast<const char*>(data), static_cast<int>(size));
    out.resize(length < 0 ? 0 : static_cast<std::size_t>(length));
    return out;
}

} // namespace burnish
