#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>

#include "core/image/io/image_io.h"
#include "small_files.h"
#include "tests/unit/data.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
using test::Bytes;

Image decoded(const Bytes& bytes)
{
    Result<Image> image = decode_image(bytes.data(), bytes.size(), "label", Limits{});
    EXPECT_TRUE(image) << (image ? "" : image.error().line());
    return image ? *image : Image{};
}

std::vector<int> u8_values(const Image& image)
{
    std::vector<int> values;
    for (const std::byte b : image.bytes)
        values.push_back(static_cast<int>(b));
    return values;
}

std::vector<float> f32_values(const Image& image)
{
    return std::vector<float>(image.f32(), image.f32() + image.bytes.size() / 4);
}

TEST(read, png_alpha_does_not_scale_colour)
{
    const Image image = decoded(test::make_png(1, 1, 8, 6, "\xC8\x64\x32\x10"));
    EXPECT_EQ(image.channels, 4);
    EXPECT_EQ(u8_values(image), (std::vector<int>{200, 100, 50, 16}));
}

TEST(read, png_palette_becomes_its_colours)
{
    const test::PngChunk palette{"PLTE", std::string("\x01\x02\x03\xFF\xFE\xFD", 6)};
    const Image image = decoded(test::make_png(2, 1, 1, 3, "\x40", {palette}));
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(u8_values(image), (std::vector<int>{1, 2, 3, 255, 254, 253}));
}

TEST(read, png_sixteen_bit_keeps_every_bit)
{
    const Image image = decoded(test::make_png(1, 1, 16, 0, "\x12\x34"));
    ASSERT_EQ(image.type, PixelType::u16);
    EXPECT_EQ(image.channels, 1);
    std::uint16_t value = 0;
    std::memcpy(&value, image.bytes.data(), 2);
    EXPECT_EQ(value, 0x1234);
}

TEST(read, png_gamma_chunk_changes_nothing)
{
    const test::PngChunk gamma{"gAMA", std::string("\0\1\x86\xA0", 4)}; // 1.0: linear
    EXPECT_EQ(u8_values(decoded(test::make_png(1, 1, 8, 2, "\x80\x40\x20", {gamma}))), (std::vector<int>{128, 64, 32}));
}

TEST(read, png_odd_side_information_is_ignored_in_silence)
{
    const std::vector<test::PngChunk> odd{{"iCCP", "not a profile"}, {"tEXt", std::string(100, 'x')}, {"oFFs", "123456789"}};
    testing::internal::CaptureStderr();
    EXPECT_EQ(u8_values(decoded(test::make_png(1, 1, 8, 2, "abc", odd))), (std::vector<int>{'a', 'b', 'c'}));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(read, exr_data_window_is_placed_in_the_display_window)
{
    test::ExrPart part{{{"Y", 2, 1.0f}}, {-1, 1, 1, 2}, {0, 0, 3, 2}, ""};
    const Image image = decoded(test::make_exr({part}));
    ASSERT_EQ(image.width, 4);
    ASSERT_EQ(image.height, 3);
    // The window's first column lies left of the display window and is cut off.
    EXPECT_EQ(f32_values(image), (std::vector<float>{0, 0, 0, 0, 2, 3, 0, 0, 102, 103, 0, 0}));
}

TEST(read, exr_channels_are_picked_by_name)
{
    test::ExrPart part{{{"A", 2, 0.5f}, {"B", 1, 3}, {"G", 1, 2}, {"N.X", 2, 7}, {"R", 1, 1}, {"Z", 2, 9}}, {0, 0, 0, 0}, {0, 0, 0, 0}, ""};
    EXPECT_EQ(f32_values(decoded(test::make_exr({part}))), (std::vector<float>{1, 2, 3, 0.5f}));
}

TEST(read, exr_depth_channel_is_not_alpha)
{
    test::ExrPart part{{{"B", 2, 3}, {"G", 2, 2}, {"R", 2, 1}, {"Z", 2, 9}}, {0, 0, 0, 0}, {0, 0, 0, 0}, ""};
    EXPECT_EQ(f32_values(decoded(test::make_exr({part}))), (std::vector<float>{1, 2, 3}));
}

TEST(read, exr_first_part_of_many)
{
    const test::ExrPart first{{{"Y", 2, 5}}, {0, 0, 0, 0}, {0, 0, 1, 0}, "scanlineimage"};
    const test::ExrPart second{{{"Y", 2, 6}}, {0, 0, 1, 0}, {0, 0, 1, 0}, "scanlineimage"};
    EXPECT_EQ(f32_values(decoded(test::make_exr({first, second}))), (std::vector<float>{5, 0}));
    EXPECT_EQ(f32_values(decoded(test::make_exr({second, first}))), (std::vector<float>{6, 7}));
}

// Reads six pixels, numbered by their red mantissa in file order, and returns them from the top row.
std::vector<int> hdr_order(const std::string& resolution, int width, int height)
{
    Bytes rgbe;
    for (std::uint8_t i = 0; i < 6; ++i)
        rgbe.insert(rgbe.end(), {static_cast<std::uint8_t>(32 * (i + 1)), 0, 0, 129});
    const Image image = decoded(test::make_hdr(resolution, rgbe));
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    std::vector<int> order;
    for (std::size_t i = 0; i < 6 && i * 12 < image.bytes.size(); ++i)
        order.push_back(static_cast<int>(std::lround(image.f32()[i * 3] * 4)) - 1);
    return order;
}

TEST(read, radiance_scanlines_of_every_order_come_top_row_first)
{
    EXPECT_EQ(hdr_order("-Y 2 +X 3", 3, 2), (std::vector<int>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(hdr_order("+Y 2 +X 3", 3, 2), (std::vector<int>{3, 4, 5, 0, 1, 2}));
    EXPECT_EQ(hdr_order("-Y 2 -X 3", 3, 2), (std::vector<int>{2, 1, 0, 5, 4, 3}));
    EXPECT_EQ(hdr_order("+Y 2 -X 3", 3, 2), (std::vector<int>{5, 4, 3, 2, 1, 0}));
    EXPECT_EQ(hdr_order("+X 2 -Y 3", 2, 3), (std::vector<int>{0, 3, 1, 4, 2, 5}));
    EXPECT_EQ(hdr_order("+X 2 +Y 3", 2, 3), (std::vector<int>{2, 5, 1, 4, 0, 3}));
    EXPECT_EQ(hdr_order("-X 2 -Y 3", 2, 3), (std::vector<int>{3, 0, 4, 1, 5, 2}));
    EXPECT_EQ(hdr_order("-X 2 +Y 3", 2, 3), (std::vector<int>{5, 2, 4, 1, 3, 0}));
}

TEST(read, memory_and_file_give_the_same_image)
{
    const Bytes png = test::make_png(2, 2, 8, 2, "abcdefghijkl");
    const std::string path = test::temporary_folder() + "/picture.bin"; // the extension does not matter
    test::put(path, png);
    const Result<Image> from_file = read_image(path, Limits{});
    ASSERT_TRUE(from_file);
    EXPECT_EQ(from_file->bytes, decoded(png).bytes);
    EXPECT_EQ(u8_values(*from_file).front(), 'a');
}

struct Expected {
    const char* name;
    int width, height, channels;
    PixelType type;
};

TEST(read, files_of_many_makers_have_their_size_and_type)
{
    const Expected expected[] = {
        {"env/OrientationLatLong_tiled_mip.exr", 1024, 512, 4, PixelType::f32},
        {"env/blender_night_1k.exr", 1024, 512, 3, PixelType::f32},
        {"env/pmndrs_lobby_512.exr", 512, 256, 3, PixelType::f32},
        {"env/workshop_1k.hdr", 1024, 512, 3, PixelType::f32},
        {"textures/lobby_16bit_131x97.png", 131, 97, 3, PixelType::u16},
        {"textures/fabric_gray_101x75.png", 101, 75, 1, PixelType::u8},
        {"textures/fabric_301x200.jpg", 301, 200, 3, PixelType::u8},
        {"textures/technicalFabricSmall_basecolor_256.png", 256, 256, 4, PixelType::u8},
        {"textures/normal_0025.webp", 512, 512, 3, PixelType::u8},
        // optional data
        {"textures/aluminium_random_brushed/aluminium_random_brushed_normal.png", 1024, 1024, 4, PixelType::u16},
        {"textures/brushed_aluminium_flow/aluminium_albedo.png", 745, 745, 1, PixelType::u8},
        {"textures/cobbles_npot/texture_rock_albedo.png", 1024, 666, 3, PixelType::u8},
        {"textures/fabric_pattern_07/fabric_pattern_07_col_1_1k.jpg", 1024, 1024, 3, PixelType::u8},
    };
    for (const Expected& e : expected) {
        if (&e - expected >= 9 && !test::has_data_file(e.name))
            continue;
        const Result<Image> image = read_image(test::data_file(e.name), Limits{});
        ASSERT_TRUE(image) << image.error().line();
        EXPECT_EQ(image->width, e.width) << e.name;
        EXPECT_EQ(image->height, e.height) << e.name;
        EXPECT_EQ(image->channels, e.channels) << e.name;
        EXPECT_EQ(image->type, e.type) << e.name;
    }
}

TEST(read, every_texture_and_environment_of_the_test_data_is_read)
{
    int files = 0;
    for (const char* folder : {"env", "textures"})
        for (const std::string& path : test::data_files(folder)) {
            if (path.ends_with(".md") || path.ends_with(".txt"))
                continue;
            const Result<Image> image = read_image(path, Limits{});
            EXPECT_TRUE(image) << (image ? "" : image.error().line());
            ++files;
        }
    EXPECT_GE(files, 10);
}

} // namespace
} // namespace burnish
