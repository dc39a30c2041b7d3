#include "core/image/io/png_write.h"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <cstring>
#include <new>
#include <stop_token>

#include "core/base/check.h"
#include "core/jobs/control.h"

namespace burnish {
namespace {

// Fast settings: Paeth's filter and runs of equal bytes need far less CPU time than the full search, for slightly
// larger files.
constexpr int kFilter = PNG_FILTER_PAETH, kStrategy = Z_RLE, kLevel = 1;
constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};

struct Output {
    std::vector<std::uint8_t> bytes;
    char message[128] = "";
    std::stop_token stop = stop_here();
};

void append(png_structp png, png_bytep data, png_size_t size)
{
    std::vector<std::uint8_t>& bytes = static_cast<Output*>(png_get_io_ptr(png))->bytes;
    bool stored = true;
    try {
        bytes.insert(bytes.end(), data, data + size);
    } catch (const std::bad_alloc&) {
        stored = false;
    }
    if (!stored) // outside the handler, which must end before the jump
        png_error(png, "not enough memory");
}

void flush(png_structp) {}

[[noreturn]] void fail(png_structp png, png_const_charp message)
{
    Output& output = *static_cast<Output*>(png_get_error_ptr(png));
    std::strncpy(output.message, message, sizeof(output.message) - 1);
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {} // libpng would print warnings on stderr

// Writes the PNG; returns false where libpng jumped back. No object here has a destructor, because the jump would skip
// it.
bool write(png_structp png, png_infop info, const Image& image, Output& output)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_write_fn(png, &output, append, flush);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, kFilter);
    png_set_compression_level(png, kLevel);
    png_set_compression_strategy(png, kStrategy);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                 kColourTypes[image.channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
    png_write_info(png, info);
    const png_const_bytep pixels = reinterpret_cast<png_const_bytep>(image.bytes.data());
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        if (output.stop.stop_requested())
            png_error(png, "stopped");
        png_write_row(png, pixels + y * row);
    }
    png_write_end(png, info);
    return true;
}

} // namespace

Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image& image)
{
    BN_CHECK(image.type == PixelType::u8 && image.channels >= 1 && image.channels <= 4);
    Output output;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool written = info && write(png, info, image, output);
    png_destroy_write_struct(&png, &info);
    check_stop();
    if (!written)
        return Error{ExitCode::output_failed, path, "",
                     std::string("the image cannot be encoded: ") + (*output.message ? output.message : "libpng does not start")};
    return std::move(output.bytes);
}

} // namespace burnish
