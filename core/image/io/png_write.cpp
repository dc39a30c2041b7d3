#include "core/image/io/png_write.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include "core/base/check.h"
#include "core/jobs/control.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Fast settings: Paeth's filter and runs of equal bytes need far less CPU time than the full search, for slightly
// larger files.
constexpr int kFilter = 4, kStrategy = Z_RLE, kLevel = 1;
// Rows are deflated in segments, each alone, so that threads share a picture. Runs need no bytes before the segment.
constexpr std::size_t kSegmentBytes = std::size_t{1} << 18;
constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};

struct Output {
    Bytes bytes;
    char message[128] = "";
};

void append(png_structp png, png_bytep data, png_size_t size)
{
    Bytes& bytes = static_cast<Output*>(png_get_io_ptr(png))->bytes;
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

// Writes all chunks before the pixels. Returns false where libpng jumped back. No object here has a destructor, because the jump would skip
// it.
bool write_header(png_structp png, png_infop info, int width, int height, int channels, Output& output)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_write_fn(png, &output, append, flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, kColourTypes[channels - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
    png_write_info(png, info);
    return true;
}

// Filters a row by Paeth (PNG specification, section 9.4). `up`: the row above, zeros above the first. step: bytes of a pixel.
void filter_row(const std::uint8_t* up, const std::uint8_t* row, std::size_t bytes, std::size_t step, std::uint8_t* to)
{
    for (std::size_t i = 0; i < step; ++i)
        to[i] = static_cast<std::uint8_t>(row[i] - up[i]);
    for (std::size_t i = step; i < bytes; ++i) {
        const int a = row[i - step], b = up[i], c = up[i - step];
        const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
        const int predicted = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
        to[i] = static_cast<std::uint8_t>(row[i] - predicted);
    }
}

struct Segment {
    Bytes deflated;   // a part of a deflate stream that ends on a byte
    uLong adler = 0;  // of the filtered rows
    z_off_t size = 0; // of the filtered rows, bytes
};

// Filters and deflates some rows. `above`: the row above them.
Segment deflated_rows(const std::uint8_t* above, const std::uint8_t* rows, std::size_t count, std::size_t row_bytes, std::size_t step)
{
    Bytes plain(count * (row_bytes + 1));
    for (std::size_t y = 0; y < count; ++y) {
        plain[y * (row_bytes + 1)] = kFilter;
        filter_row(y == 0 ? above : rows + (y - 1) * row_bytes, rows + y * row_bytes, row_bytes, step, &plain[y * (row_bytes + 1) + 1]);
    }
    Segment segment;
    segment.adler = adler32_z(adler32_z(0, nullptr, 0), plain.data(), plain.size());
    segment.size = static_cast<z_off_t>(plain.size());
    z_stream stream = {};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, -MAX_WBITS, 8, kStrategy) != Z_OK)
        throw std::bad_alloc();
    segment.deflated.resize(deflateBound(&stream, static_cast<uLong>(plain.size())) + 16);
    stream.next_in = plain.data(), stream.avail_in = static_cast<uInt>(plain.size());
    stream.next_out = segment.deflated.data(), stream.avail_out = static_cast<uInt>(segment.deflated.size());
    const int done = deflate(&stream, Z_SYNC_FLUSH);
    const bool whole = done == Z_OK && stream.avail_in == 0 && stream.avail_out > 0;
    segment.deflated.resize(segment.deflated.size() - stream.avail_out);
    deflateEnd(&stream);
    BN_CHECK(whole);
    return segment;
}

void append_number(Bytes& to, uLong value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        to.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(Bytes& to, const char* kind, const Bytes& data)
{
    append_number(to, static_cast<uLong>(data.size()));
    const std::size_t begin = to.size();
    to.insert(to.end(), kind, kind + 4);
    to.insert(to.end(), data.begin(), data.end());
    append_number(to, crc32_z(crc32_z(0, nullptr, 0), to.data() + begin, to.size() - begin));
}

} // namespace

struct PngEncoder::State {
    std::string path;
    std::size_t row_bytes = 0, step = 0, segment_rows = 0;
    Bytes waiting; // rows of an unfinished segment
    Bytes above;   // the row above `waiting`
    uLong adler = 0;
    bool begun = false; // the zlib stream's header is written

    Error error(const std::string& reason) const { return {ExitCode::output_failed, path, "", "the image cannot be encoded: " + reason}; }

    // Appends `count` waiting rows to a file, in chunks, and removes them. last: ends the zlib stream.
    void encode(std::size_t count, bool last, const Jobs* jobs, Bytes& to)
    {
        std::vector<Segment> segments((count + segment_rows - 1) / segment_rows + (last && count == 0 ? 1 : 0));
        const auto make = [&](std::size_t i, int) {
            const std::size_t first = i * segment_rows;
            const std::uint8_t* const rows = waiting.data() + first * row_bytes;
            segments[i] =
                deflated_rows(i == 0 ? above.data() : rows - row_bytes, rows, std::min(segment_rows, count - first), row_bytes, step);
        };
        if (jobs && segments.size() > 1)
            jobs->parallel_for(segments.size(), make);
        else
            for (std::size_t i = 0; i * segment_rows < count; ++i)
                check_stop(), make(i, 0);
        for (Segment& segment : segments) {
            if (segment.size > 0)
                adler = adler32_combine(adler, segment.adler, segment.size);
            if (!std::exchange(begun, true))
                segment.deflated.insert(segment.deflated.begin(), {0x78, 0x01}); // zlib: deflate, a window of 32 KiB, fastest
            if (last && &segment == &segments.back()) {
                segment.deflated.insert(segment.deflated.end(), {0x03, 0x00}); // an empty last block
                append_number(segment.deflated, adler);
            }
            append_chunk(to, "IDAT", segment.deflated);
        }
        if (count > 0)
            above.assign(waiting.begin() + static_cast<std::ptrdiff_t>((count - 1) * row_bytes),
                         waiting.begin() + static_cast<std::ptrdiff_t>(count * row_bytes));
        waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count * row_bytes));
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
    s.step = static_cast<std::size_t>(channels), s.row_bytes = static_cast<std::size_t>(width) * s.step;
    s.segment_rows = std::max<std::size_t>(1, kSegmentBytes / s.row_bytes);
    s.above.assign(s.row_bytes, 0);
    s.adler = adler32_z(0, nullptr, 0);
    Output output;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool written = info && write_header(png, info, width, height, channels, output);
    png_destroy_write_struct(&png, &info);
    if (!written)
        return s.error(*output.message ? output.message : "libpng does not start");
    return std::move(output.bytes);
}

Result<std::vector<std::uint8_t>> PngEncoder::rows(const Image& rows, const Jobs* jobs)
{
    BN_CHECK(rows.type == PixelType::u8);
    State& s = *state_;
    constexpr std::size_t kAtOnce = std::size_t{1} << 24; // bytes that are copied, filtered and deflated together
    try {
        const auto* const pixels = reinterpret_cast<const std::uint8_t*>(rows.bytes.data());
        const std::size_t step = std::max(s.segment_rows * s.row_bytes, kAtOnce / s.row_bytes * s.row_bytes);
        Bytes bytes;
        for (std::size_t at = 0; at < rows.bytes.size(); at += step) {
            s.waiting.insert(s.waiting.end(), pixels + at, pixels + std::min(at + step, rows.bytes.size()));
            const std::size_t there = s.waiting.size() / s.row_bytes;
            s.encode(there - there % s.segment_rows, false, jobs, bytes);
        }
        return bytes;
    } catch (const std::bad_alloc&) {
        return s.error("not enough memory");
    }
}

Result<std::vector<std::uint8_t>> PngEncoder::end()
{
    State& s = *state_;
    try {
        Bytes bytes;
        s.encode(s.waiting.size() / s.row_bytes, true, nullptr, bytes);
        append_chunk(bytes, "IEND", {});
        return bytes;
    } catch (const std::bad_alloc&) {
        return s.error("not enough memory");
    }
}

Result<std::vector<std::uint8_t>> png_bytes(const std::string& path, const Image& image, const Jobs* jobs)
{
    PngEncoder encoder(path);
    Result<Bytes> bytes = encoder.begin(image.width, image.height, image.channels);
    BN_TRY(bytes);
    for (const auto& more : {encoder.rows(image, jobs), encoder.end()}) {
        BN_TRY(more);
        bytes->insert(bytes->end(), more->begin(), more->end());
    }
    return bytes;
}

} // namespace burnish
