// Replaces png_read.cpp, jpeg_read.cpp and inflate.cpp in WebAssembly, which has neither libpng nor libjpeg. PNG has one right picture.
// JPEG decoders differ by a few steps of 255. So pages that promise a hash bring JPEG images decoded by libjpeg, in /decoded.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
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
Status read_by_stb(const ImageBytes& file, const std::uint8_t* data, std::size_t size, const PlacePixels& place)
{
    const auto fault = [&] {
        const char* const reason = stbi_failure_reason();
        return file.error("", reason && std::strcmp(reason, "outofmem") == 0 ? "out of memory"
                                                                             : fmt::format("is damaged: {}", reason ? reason : ""));
    };
    const int length = static_cast<int>(size);
    const bool wide = stbi_is_16_bit_from_memory(data, length) != 0;
    StoredHeader header; // channels with those that a colour for transparency adds
    const Pixels pixels(wide
                            ? static_cast<void*>(stbi_load_16_from_memory(data, length, &header.width, &header.height, &header.channels, 0))
                            : static_cast<void*>(stbi_load_from_memory(data, length, &header.width, &header.height, &header.channels, 0)),
                        stbi_image_free);
    if (!pixels)
        return fault();
    header.full_width = header.width, header.full_height = header.height, header.depth = 1,
    header.type = wide ? PixelType::u16 : PixelType::u8;
    header.channel_names = header.channels <= 2 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G", "B", "A"};
    header.channel_names.resize(static_cast<std::size_t>(header.channels));
    const Result<PixelRequest> wanted = place(header);
    BN_TRY(wanted);
    const std::size_t pixel = static_cast<std::size_t>(header.channels) * pixel_type_bytes(header.type);
    const auto first = static_cast<std::size_t>(wanted->first), end = static_cast<std::size_t>(wanted->end);
    const std::size_t sample = pixel_type_bytes(header.type), taken = (end - first) * sample;
    const std::size_t count = static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
    const std::byte* const from = static_cast<const std::byte*>(pixels.get()) + first * sample;
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(wanted->to + i * taken, from + i * pixel, taken);
    return {};
}

std::string decoded_path(const ImageBytes& file)
{
    return fmt::format("/decoded/{:016x}.png", hash_bytes(file.data, file.size, 0));
}

} // namespace

std::optional<Status> read_png(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place)
{
    const bool own = probe.replacement.empty();
    return read_by_stb(file, own ? file.data : probe.replacement.data(), own ? file.size : probe.replacement.size(), place);
}

std::optional<Status> read_webp(const ImageBytes&, const PlacePixels&)
{
    return std::nullopt;
}

std::optional<Status> read_jpeg(const ImageBytes& file, const PlacePixels& place)
{
    const Result<std::vector<std::uint8_t>> decoded = read_file(decoded_path(file), kMostDecoded);
    return decoded ? read_by_stb(file, decoded->data(), decoded->size(), place) : read_by_stb(file, file.data, file.size, place);
}

std::optional<Status> read_pfm(const ImageBytes& file, const PlacePixels& place)
{
    constexpr std::size_t kMostHead = 64;
    const std::string head(reinterpret_cast<const char*>(file.data), std::min(file.size, kMostHead));
    StoredHeader header;
    float scale = 0.0f;
    int length = 0;
    if (std::sscanf(head.c_str(), "PF %d %d %f%n", &header.width, &header.height, &scale, &length) != 3 || scale != -1.0f)
        return std::nullopt;
    header.full_width = header.width, header.full_height = header.height, header.depth = 1, header.type = PixelType::f32;
    header.channels = 3, header.channel_names = {"R", "G", "B"};
    const std::size_t row = 12 * static_cast<std::size_t>(header.width), from = static_cast<std::size_t>(length) + 1;
    if (file.size < from || (file.size - from) / row < static_cast<std::size_t>(header.height))
        return file.error("", "ends within its pixels");
    const Result<PixelRequest> wanted = place(header);
    if (!wanted)
        return Status(wanted.error());
    if (wanted->first != 0 || wanted->end != 3)
        return std::nullopt;
    for (std::size_t y = 0; y < static_cast<std::size_t>(header.height); ++y) // the lowest row comes first
        std::memcpy(wanted->to + y * row, file.data + from + (static_cast<std::size_t>(header.height) - 1 - y) * row, row);
    return Status();
}

std::string jpeg_warning(const ImageBytes& file)
{
    return read_file(decoded_path(file), kMostDecoded)
               ? ""
               : "is a JPEG image: its texels may differ by a few steps of 255 from those of other machines";
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
