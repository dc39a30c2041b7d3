#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>

#include "core/image/io/common_formats.h"

namespace burnish {
namespace {

struct PngInput {
    const std::uint8_t* data;
    std::size_t size, at;
};

struct Png {
    png_structp file = nullptr;
    png_infop info = nullptr;
    ~Png() { png_destroy_read_struct(&file, &info, nullptr); }
};

[[noreturn]] void stop_png(png_structp png, png_const_charp)
{
    png_longjmp(png, 1);
}

void take_bytes(png_structp png, png_bytep to, png_size_t size)
{
    PngInput& input = *static_cast<PngInput*>(png_get_io_ptr(png));
    if (size > input.size - input.at)
        png_error(png, "the file ends");
    std::memcpy(to, input.data + input.at, size);
    input.at += size;
}

// Reads the header, and asks for samples of 8 or 16 bits, without a palette. Returns false where libpng jumped back. No object here or in
// read_rows() has a destructor, because the jump would skip it.
bool read_header(const Png& png, PngInput& input, StoredHeader& header, int& passes)
{
    if (setjmp(png_jmpbuf(png.file)))
        return false;
    png_set_read_fn(png.file, &input, take_bytes);
    png_set_crc_action(png.file, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE); // the guard has checked them
    png_read_info(png.file, png.info);
    const int colour = png_get_color_type(png.file, png.info);
    if (colour == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(png.file);
    if (colour == PNG_COLOR_TYPE_GRAY && png_get_bit_depth(png.file, png.info) < 8)
        png_set_expand_gray_1_2_4_to_8(png.file);
    if (png_get_valid(png.file, png.info, PNG_INFO_tRNS))
        png_set_tRNS_to_alpha(png.file);
    if (std::endian::native == std::endian::little)
        png_set_swap(png.file);
    passes = png_set_interlace_handling(png.file);
    png_read_update_info(png.file, png.info);
    header.width = header.full_width = static_cast<int>(png_get_image_width(png.file, png.info));
    header.height = header.full_height = static_cast<int>(png_get_image_height(png.file, png.info));
    header.depth = 1, header.channels = png_get_channels(png.file, png.info);
    header.type = png_get_bit_depth(png.file, png.info) == 16 ? PixelType::u16 : PixelType::u8;
    return true;
}

bool read_rows(const Png& png, int passes, int height, std::size_t row_bytes, std::byte* to)
{
    if (setjmp(png_jmpbuf(png.file)))
        return false;
    for (int pass = 0; pass < passes; ++pass)
        for (int y = 0; y < height; ++y)
            png_read_row(png.file, reinterpret_cast<png_bytep>(to) + static_cast<std::size_t>(y) * row_bytes, nullptr);
    png_read_end(png.file, nullptr);
    return true;
}

} // namespace

std::optional<Status> read_png(const ImageBytes& file, const ImageProbe& probe, const PlacePixels& place)
{
    const bool own = probe.replacement.empty();
    PngInput input{own ? file.data : probe.replacement.data(), own ? file.size : probe.replacement.size(), 0};
    Png png;
    png.file = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, stop_png, stop_png); // a warning is a fault too
    png.info = png.file ? png_create_info_struct(png.file) : nullptr;
    StoredHeader header;
    int passes = 1;
    if (!png.info || !read_header(png, input, header, passes))
        return std::nullopt;
    const std::size_t row_bytes = png_get_rowbytes(png.file, png.info);
    if (header.channels < 1 || header.channels > 4 ||
        row_bytes != static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.channels) * pixel_type_bytes(header.type))
        return std::nullopt;
    header.channel_names = header.channels <= 2 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G", "B", "A"};
    header.channel_names.resize(static_cast<std::size_t>(header.channels));
    const Result<PixelRequest> wanted = place(header);
    if (!wanted)
        return Status(wanted.error());
    if (wanted->first != 0 || wanted->end != header.channels || !read_rows(png, passes, header.height, row_bytes, wanted->to))
        return std::nullopt;
    return Status();
}

} // namespace burnish
