#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>

#include "core/image/io/common_formats.h"

namespace burnish {
namespace {

struct Errors {
    jpeg_error_mgr manager; // first: libjpeg passes a pointer to it
    std::jmp_buf jump;
};

struct Jpeg {
    jpeg_decompress_struct file = {};
    Errors errors = {};
    ~Jpeg() { jpeg_destroy_decompress(&file); }
};

[[noreturn]] void stop_jpeg(j_common_ptr file)
{
    std::longjmp(reinterpret_cast<Errors*>(file->err)->jump, 1);
}

void stop_at_warning(j_common_ptr file, int level)
{
    if (level < 0) // a warning is a fault too
        stop_jpeg(file);
}

void say_nothing(j_common_ptr) {}

// Reads the header. Returns false for a fault, and for colours that the image library converts. No object here or in read_rows() has a
// destructor, because the jump would skip it.
bool read_header(Jpeg& jpeg, const ImageBytes& file)
{
    if (setjmp(jpeg.errors.jump))
        return false;
    jpeg_create_decompress(&jpeg.file);
    jpeg_mem_src(&jpeg.file, file.data, static_cast<unsigned long>(file.size));
    jpeg_read_header(&jpeg.file, TRUE);
    const J_COLOR_SPACE space = jpeg.file.jpeg_color_space;
    return (space == JCS_GRAYSCALE && jpeg.file.num_components == 1) ||
           ((space == JCS_YCbCr || space == JCS_RGB) && jpeg.file.num_components == 3);
}

bool read_rows(Jpeg& jpeg, std::size_t row_bytes, std::byte* to)
{
    if (setjmp(jpeg.errors.jump))
        return false;
    jpeg_start_decompress(&jpeg.file);
    if (jpeg.file.output_components != jpeg.file.num_components)
        return false;
    while (jpeg.file.output_scanline < jpeg.file.output_height) {
        JSAMPROW row = reinterpret_cast<JSAMPROW>(to) + jpeg.file.output_scanline * row_bytes;
        if (jpeg_read_scanlines(&jpeg.file, &row, 1) != 1)
            return false;
    }
    jpeg_finish_decompress(&jpeg.file);
    return true;
}

} // namespace

std::string jpeg_warning(const ImageBytes&)
{
    return "";
}

std::optional<Status> read_jpeg(const ImageBytes& file, const PlacePixels& place)
{
    Jpeg jpeg;
    jpeg.file.err = jpeg_std_error(&jpeg.errors.manager);
    jpeg.errors.manager.error_exit = stop_jpeg, jpeg.errors.manager.emit_message = stop_at_warning;
    jpeg.errors.manager.output_message = say_nothing;
    if (!read_header(jpeg, file))
        return std::nullopt;
    StoredHeader header;
    header.width = header.full_width = static_cast<int>(jpeg.file.image_width);
    header.height = header.full_height = static_cast<int>(jpeg.file.image_height);
    header.depth = 1, header.channels = jpeg.file.num_components, header.type = PixelType::u8;
    header.channel_names = header.channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    const Result<PixelRequest> wanted = place(header);
    if (!wanted)
        return Status(wanted.error());
    const std::size_t row_bytes = static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.channels);
    if (wanted->first != 0 || wanted->end != header.channels || !read_rows(jpeg, row_bytes, wanted->to))
        return std::nullopt;
    return Status();
}

} // namespace burnish
