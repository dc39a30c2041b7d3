// PNG and JPEG by their own libraries: the pixels of the image library.
#include "core/image/io/common_formats.h"
#include "core/image/io/image_io.h"

#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <png.h>
#include <webp/encode.h>

#include "tests/unit/image/small_files.h"

namespace burnish::test {
namespace {

struct Decoded {
    StoredHeader header;
    std::vector<std::byte> bytes;
    PlacePixels place()
    {
        return [this](const StoredHeader& found) -> Result<PixelRequest> {
            header = found;
            bytes.assign(static_cast<std::size_t>(found.width) * static_cast<std::size_t>(found.height) *
                             static_cast<std::size_t>(found.channels) * pixel_type_bytes(found.type),
                         std::byte{0xAA});
            return PixelRequest{0, found.channels, bytes.data()};
        };
    }
};

// Returns true if the file's own library reads it, with what the image library reads.
testing::AssertionResult alike(const Bytes& bytes)
{
    const ImageBytes file{bytes.data(), bytes.size(), "file"};
    const Result<ImageProbe> probe = probe_image(file, Limits());
    if (!probe)
        return testing::AssertionFailure() << probe.error().line();
    Decoded own, other;
    const std::string format = probe->format;
    const std::optional<Status> read = format == "png"    ? read_png(file, *probe, own.place())
                                       : format == "webp" ? read_webp(file, own.place())
                                                          : read_jpeg(file, own.place());
    if (!read || !*read)
        return testing::AssertionFailure() << "is left to the image library";
    const Result<const ImageLibrary*> library = image_library("file");
    if (!library)
        return testing::AssertionFailure() << library.error().line();
    if (const Status status = (*library)->read(file, *probe, other.place()); !status)
        return testing::AssertionFailure() << status.error().line();
    const StoredHeader &a = own.header, &b = other.header;
    if (a.width != b.width || a.height != b.height || a.channels != b.channels || a.type != b.type || a.channel_names != b.channel_names ||
        a.depth != b.depth || a.full_width != b.full_width || a.full_height != b.full_height || a.x != b.x || a.y != b.y)
        return testing::AssertionFailure() << "the headers differ";
    return own.bytes == other.bytes ? testing::AssertionSuccess() : testing::AssertionFailure() << "the pixels differ";
}

// Returns pixels of noise over a slope.
Bytes noise(std::size_t size)
{
    Bytes bytes(size);
    std::uint32_t state = 7;
    for (std::size_t i = 0; i < size; ++i) {
        state = state * 1664525u + 1013904223u;
        bytes[i] = static_cast<std::uint8_t>(i * 3 + (state >> 27));
    }
    return bytes;
}

constexpr int kWidth = 37, kHeight = 21; // no multiple of a block

Bytes png_of(int colour, int depth, bool interlaced, bool clear)
{
    Bytes file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &file,
        [](png_structp to, png_bytep data, png_size_t size) {
            Bytes& all = *static_cast<Bytes*>(png_get_io_ptr(to));
            all.insert(all.end(), data, data + size);
        },
        nullptr);
    png_set_IHDR(png, info, kWidth, kHeight, depth, colour, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_color palette[256];
    for (int i = 0; i < 256; ++i)
        palette[i] = {static_cast<png_byte>(i), static_cast<png_byte>(255 - i), static_cast<png_byte>(7 * i)};
    if (colour == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, palette, 1 << depth);
    png_byte alphas[] = {0, 77};
    png_color_16 key = {0, 1, 1, 1, 1};
    if (clear)
        png_set_tRNS(png, info, alphas, colour == PNG_COLOR_TYPE_PALETTE ? 2 : 0, &key);
    png_write_info(png, info);
    const std::size_t row = png_get_rowbytes(png, info);
    Bytes pixels = noise(row * kHeight);
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < kHeight; ++y)
        rows.push_back(pixels.data() + y * row);
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

Bytes jpeg_of(J_COLOR_SPACE space, int channels, int quality, bool progressive, bool small_chroma)
{
    jpeg_compress_struct jpeg = {};
    jpeg_error_mgr errors = {};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &data, &size);
    jpeg.image_width = kWidth, jpeg.image_height = kHeight, jpeg.input_components = channels, jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    if (!small_chroma && channels == 3)
        jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
    if (progressive)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    const std::size_t row = static_cast<std::size_t>(kWidth * channels);
    Bytes pixels = noise(row * kHeight);
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW at = pixels.data() + jpeg.next_scanline * row;
        jpeg_write_scanlines(&jpeg, &at, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    const Bytes file(data, data + size);
    std::free(data);
    return file;
}

TEST(common_formats, png_has_the_pixels_of_the_image_library)
{
    const int kinds[][2] = {{0, 1}, {0, 2}, {0, 4}, {0, 8}, {0, 16}, {2, 8}, {2, 16}, {3, 1},
                            {3, 2}, {3, 4}, {3, 8}, {4, 8}, {4, 16}, {6, 8}, {6, 16}};
    for (const auto& [colour, depth] : kinds)
        for (const bool interlaced : {false, true})
            for (const bool clear : {false, true}) {
                if (clear && colour >= 4)
                    continue;
                EXPECT_TRUE(alike(png_of(colour, depth, interlaced, clear)))
                    << "colour type " << colour << ", " << depth << " bits" << (interlaced ? ", interlaced" : "")
                    << (clear ? ", tRNS" : "");
            }
}

TEST(common_formats, jpeg_has_the_pixels_of_the_image_library)
{
    for (const bool progressive : {false, true})
        for (const int quality : {20, 75, 100}) {
            EXPECT_TRUE(alike(jpeg_of(JCS_GRAYSCALE, 1, quality, progressive, false))) << "grey, quality " << quality;
            for (const bool small_chroma : {false, true})
                EXPECT_TRUE(alike(jpeg_of(JCS_RGB, 3, quality, progressive, small_chroma))) << "colour, quality " << quality;
        }
    const Bytes inks = jpeg_of(JCS_CMYK, 4, 75, false, false);
    Decoded own;
    EXPECT_FALSE(read_jpeg({inks.data(), inks.size(), "file"}, own.place())) << "the image library converts inks";
}

Bytes webp_of(bool alpha, bool lossless)
{
    const Bytes pixels = noise(static_cast<std::size_t>(kWidth * kHeight) * (alpha ? 4 : 3));
    const int row = kWidth * (alpha ? 4 : 3);
    std::uint8_t* data = nullptr;
    const std::size_t size = lossless ? (alpha ? WebPEncodeLosslessRGBA : WebPEncodeLosslessRGB)(pixels.data(), kWidth, kHeight, row, &data)
                                      : (alpha ? WebPEncodeRGBA : WebPEncodeRGB)(pixels.data(), kWidth, kHeight, row, 70.0f, &data);
    const Bytes file(data, data + size);
    WebPFree(data);
    return file;
}

TEST(common_formats, webp_has_the_pixels_of_the_image_library)
{
    for (const bool lossless : {false, true})
        EXPECT_TRUE(alike(webp_of(false, lossless))) << (lossless ? "lossless" : "lossy");
}

// The image library multiplies colours of WebP by alpha.
TEST(common_formats, webp_with_alpha_has_its_own_colours)
{
    const Bytes file = webp_of(true, true), pixels = noise(static_cast<std::size_t>(kWidth * kHeight) * 4);
    const Result<Image> read = decode_image(file.data(), file.size(), "file", Limits());
    ASSERT_TRUE(read);
    ASSERT_EQ(read->channels, 4);
    ASSERT_EQ(read->bytes.size(), pixels.size());
    int clear = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
        const bool hidden = pixels[i + 3] == 0; // libwebp writes other colours there
        clear += hidden ? 1 : 0;
        for (std::size_t c = hidden ? 3 : 0; c < 4; ++c)
            EXPECT_EQ(static_cast<std::uint8_t>(read->bytes[i + c]), pixels[i + c]) << i << " " << c;
    }
    EXPECT_LT(clear, kWidth * kHeight / 10);
    EXPECT_EQ(decode_image(file.data(), file.size() - 20, "file", Limits()).error().code, ExitCode::bad_input);
}

TEST(common_formats, faults_are_left_to_the_image_library)
{
    for (Bytes file : {png_of(2, 8, false, false), jpeg_of(JCS_RGB, 3, 75, false, true), webp_of(true, true), webp_of(false, false)}) {
        const bool png = file[0] == 0x89, webp = file[0] == 'R';
        file.resize(file.size() * 2 / 3);
        Decoded own;
        const ImageBytes bytes{file.data(), file.size(), "file"};
        EXPECT_FALSE(png ? read_png(bytes, {"png"}, own.place()) : webp ? read_webp(bytes, own.place()) : read_jpeg(bytes, own.place()));
        const PlacePixels refuse = [](const StoredHeader&) -> Result<PixelRequest> {
            return Error{ExitCode::bad_input, "", "", "refused"};
        };
        const std::optional<Status> refused = png    ? read_png(bytes, {"png"}, refuse)
                                              : webp ? read_webp(bytes, refuse)
                                                     : read_jpeg(bytes, refuse);
        ASSERT_TRUE(refused);
        EXPECT_EQ(refused->error().reason, "refused");
    }
}

} // namespace
} // namespace burnish::test
