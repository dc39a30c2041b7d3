// Writes images: encodes the file in memory first, so that the file is complete before its name appears on disk.
#include <algorithm>
#include <cctype>
#include <cstring>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/base/exception.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "core/image/io/image_library.h"
#include "core/image/io/plain_formats.h"
#include "core/image/io/png_write.h"
#include "core/jobs/control.h"

namespace burnish {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Largest value in a Radiance shared-exponent pixel: mantissa 255/256, exponent 127.
constexpr float kRgbeMax = 255.0f / 256.0f * 0x1p127f;

struct Format {
    const char* name; // OpenImageIO's name, where OpenImageIO writes the format
    bool floats;
    bool alpha;
    bool gray;
};

// Returns the format that the extension names; name is nullptr where the extension names none.
Format format_of(const std::string& path)
{
    const std::size_t dot = path.find_last_of("./");
    std::string extension = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == "exr")
        return {"openexr", true, true, true};
    if (extension == "hdr")
        return {"hdr", true, false, false};
    if (extension == "pfm")
        return {"pfm", true, false, true};
    if (extension == "png")
        return {"png", false, true, true};
    if (extension == "jpg" || extension == "jpeg")
        return {"jpeg", false, false, true};
    if (extension == "tif" || extension == "tiff")
        return {"tiff", false, true, true};
    return {nullptr, false, false, false};
}

Error output_error(const std::string& path, const std::string& reason)
{
    return {ExitCode::output_failed, path, "", reason};
}

// Converts to channels that the format can hold: drops alpha, repeats gray to RGB.
Image fit_channels(const Image& image, const Format& format)
{
    const bool colour = image.channels >= 3;
    const bool alpha = image.channels % 2 == 0 && format.alpha;
    const int channels = (colour || !format.gray ? 3 : 1) + (alpha ? 1 : 0);
    if (channels == image.channels)
        return image;
    Image out = make_image(image.width, image.height, channels, image.type);
    const std::size_t sample = pixel_type_bytes(image.type);
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const std::size_t step_in = sample * static_cast<std::size_t>(image.channels);
    const std::size_t step_out = sample * static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
            std::memcpy(out.bytes.data() + i * step_out + c * sample, image.bytes.data() + i * step_in + (colour ? c * sample : 0), sample);
    return out;
}

bool holds_its_pixels(const Image& image)
{
    if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.type > PixelType::f32)
        return false;
    const std::size_t texel = static_cast<std::size_t>(image.channels) * pixel_type_bytes(image.type);
    return image.bytes.size() % texel == 0 &&
           image.bytes.size() / texel == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

// RGBE holds no negative values, NaN or Inf.
void clamp_to_rgbe(Image& image)
{
    float* values = image.f32();
    const std::size_t count = image.bytes.size() / sizeof(float);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = values[i] > 0.0f ? std::min(values[i], kRgbeMax) : 0.0f;
}

Result<Bytes> encode_by_library(const ImageLibrary& library, const std::string& path, const Image& image, const char* format,
                                const std::vector<std::string>& channels)
{
    Result<Bytes> bytes = library.encode(path, image, format, channels, stop_here());
    check_stop(); // in place of an error that says so
    return bytes;
}

Result<Bytes> encode_image(const std::string& path, const Image& image, const Format& format, const Jobs* jobs)
{
    check_stop();
    Image fitted = fit_channels(image, format);
    if (std::strcmp(format.name, "pfm") == 0)
        return encode_pfm(fitted);
    if (std::strcmp(format.name, "tiff") == 0)
        return encode_tiff(fitted);
    if (std::strcmp(format.name, "png") == 0)
        return png_bytes(path, fitted, jobs);
    if (std::strcmp(format.name, "hdr") == 0)
        clamp_to_rgbe(fitted);
    const Result<const ImageLibrary*> library = image_library(path);
    BN_TRY(library);
    return encode_by_library(**library, path, fitted, format.name, {});
}

} // namespace

bool stores_floats(const std::string& path)
{
    const Format format = format_of(path);
    return format.name && format.floats;
}

bool is_png(const std::string& path)
{
    const Format format = format_of(path);
    return format.name && std::strcmp(format.name, "png") == 0;
}

bool stores_channels(const std::string& path)
{
    const Format format = format_of(path);
    return format.name && std::strcmp(format.name, "openexr") == 0;
}

Status write_image(const std::string& path, const Image& image, const Jobs* jobs)
{
    if (image.channels > 4 || !holds_its_pixels(image))
        return output_error(path, "the picture's bytes are not those of its size and channels");
    const Format format = format_of(path);
    if (!format.name)
        return output_error(path, "the extension names no format that can be written (exr, hdr, pfm, png, jpg, tif)");
    if (image.type != (format.floats ? PixelType::f32 : PixelType::u8))
        return output_error(path, format.floats ? "this format needs float pixels" : "this format needs 8-bit pixels");
    try {
        const Result<Bytes> bytes = encode_image(path, image, format, jobs);
        BN_TRY(bytes);
        check_stop();
        return write_file_atomic(path, bytes->data(), bytes->size());
    } catch (...) {
        return error_of_exception(output_error(path, "the image cannot be encoded"));
    }
}

Status write_channels(const std::string& path, const Image& image, const std::vector<std::string>& names)
{
    if (image.type != PixelType::f32 || !holds_its_pixels(image) || names.size() != static_cast<std::size_t>(image.channels))
        return output_error(path, "the picture's bytes are not floats of its size and of the named channels");
    if (!stores_channels(path))
        return output_error(path, "this format has no channels of any name (exr)");
    try {
        const Result<const ImageLibrary*> library = image_library(path);
        BN_TRY(library);
        const Result<Bytes> bytes = encode_by_library(**library, path, image, format_of(path).name, names);
        BN_TRY(bytes);
        return write_file_atomic(path, bytes->data(), bytes->size());
    } catch (...) {
        return error_of_exception(output_error(path, "the image cannot be encoded"));
    }
}

Result<std::vector<std::uint8_t>> encode_exr_levels(const std::string& path, const std::vector<Image>& levels)
{
    BN_CHECK(!levels.empty() && levels[0].type == PixelType::f32);
    try {
        const Result<const ImageLibrary*> library = image_library(path);
        BN_TRY(library);
        return (*library)->encode_levels(path, levels);
    } catch (...) {
        return error_of_exception(output_error(path, "the levels cannot be encoded"));
    }
}

Result<std::string> encode_png(const Image& image, const Jobs* jobs)
{
    if (image.type != PixelType::u8 || image.channels > 4 || !holds_its_pixels(image))
        return output_error("picture.png", "the picture's bytes are not those of its size and channels");
    try {
        const Result<Bytes> bytes = encode_image("picture.png", image, format_of("picture.png"), jobs);
        BN_TRY(bytes);
        return std::string(bytes->begin(), bytes->end());
    } catch (...) {
        return error_of_exception(output_error("picture.png", "the image cannot be encoded"));
    }
}

Status write_file(const std::string& path, const std::string& bytes)
{
    return write_file_atomic(path, bytes.data(), bytes.size());
}

} // namespace burnish
