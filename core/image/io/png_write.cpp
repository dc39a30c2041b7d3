#include "core/image/io/png_write.h"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <cstring>
#include <new>
#include <stop_token>
#include <utility>

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

// Each of these returns false where libpng jumped back. No object in them has a destructor, because the jump would skip
// it.
bool write_header(png_structp png, png_infop info, int width, int height, int channels, Output& output)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_write_fn(png, &output, append, flush);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, kFilter);
    png_set_compression_level(png, kLevel);
    png_set_compression_strategy(png, kStrategy);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, kColourTypes[channels - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
    png_write_info(png, info);
    return true;
}
bool write_rows(png_structp png, const Image& rows, Output& output)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    const png_const_bytep pixels = reinterpret_cast<png_const_bytep>(rows.bytes.data());
    const std::size_t row = static_cast<std::size_t>(rows.width) * static_cast<std::size_t>(rows.channels);
    for (std::size_t y = 0; y < static_cast<std::size_t>(rows.height); ++y) {
        if (output.stop.stop_requested())
            png_error(png, "stopped");
        png_write_row(png, pixels + y * row);
    }
    return true;
}
bool write_end(png_structp png, png_infop info)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_write_end(png, info);
    return true;
}

} // namespace

struct PngEncoder::State {
    std::string path;
    Output output;
    png_structp png = nullptr;
    png_infop info = nullptr;

    ~State() { png_destroy_write_struct(&png, &info); }
    Result<std::vector<std::uint8_t>> taken(bool written)
    {
        check_stop();
        if (!written)
            return Error{ExitCode::output_failed, path, "",
                         std::string("the image cannot be encoded: ") + (*output.message ? output.message : "libpng does not start")};
        return std::exchange(output.bytes, {});
    }
};

PngEncoder::PngEncoder(const std::string& path) : state_(std::make_unique<State>())
{
    state_->path = path;
}
PngEncoder::PngEncoder(PngEncoder&&) noexcept = default;
PngEncoder::~PngEncoder() = default;

Result<std::vector<std::uint8_t>> PngEncoder::begin(int width, int height, int channels)
{
    BN_CHECK(channels >= 1 && channels <= 4);
    State& s = *state_;
    s.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &s.output, fail, ignore);
    s.info = s.png ? png_create_info_struct(s.png) : nullptr;
    return s.taken(s.info && write_header(s.png, s.info, width, height, channels, s.output));
}

Result<std::vector<std::uint8_t>> PngEncoder::rows(const Image& rows)
{
    BN_CHECK(rows.type == PixelType::u8);
    return state_->taken(write_rows(state_->png, rows, state_->output));
}

Result<std::vector<std::uint8_t>> PngEncoder::end()
{
    return state_->taken(write_end(state_->png, state_->info));
}

Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image& image)
{
    PngEncoder encoder(path);
    Result<std::vector<std::uint8_t>> bytes = encoder.begin(image.width, image.height, image.channels);
    for (const auto step : {+[](PngEncoder&e, const Image&i) { return e.rows(i); }, +[](PngEncoder&e, const Image&) { return e.end(); }}) {
        BN_TRY(bytes);
        Result<std::vector<std::uint8_t>> more = step(encoder, image);
        BN_TRY(more);
        bytes->insert(bytes->end(), more->begin(), more->end());
    }
    return bytes;
}

} // namespace burnish
