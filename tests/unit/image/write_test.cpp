#include <gtest/gtest.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <thread>

#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "core/image/io/image_stream.h"
#include "small_files.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
using test::Bytes;

Image gradient8(int channels)
{
    Image image = make_image(13, 7, channels, PixelType::u8);
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
        image.bytes[i] = static_cast<std::byte>(i * 7 + i / 5);
    return image;
}

Image gradient32(int channels)
{
    Image image = make_image(13, 7, channels, PixelType::f32);
    for (std::size_t i = 0; i < image.bytes.size() / 4; ++i)
        image.f32()[i] = static_cast<float>(i) * 0.37f + 0.01f;
    return image;
}

Image back(const std::string& path)
{
    const Result<Image> image = read_image(path, Limits{});
    EXPECT_TRUE(image) << (image ? "" : image.error().line());
    return image ? *image : Image{};
}

void expect_same(const Image& a, const Image& b)
{
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.type, b.type);
    EXPECT_TRUE(a.bytes == b.bytes);
}

TEST(write, exr_keeps_every_bit)
{
    const std::string folder = test::temporary_folder();
    for (int channels = 1; channels <= 4; ++channels) {
        Image image = gradient32(channels);
        image.f32()[0] = 1e30f;
        image.f32()[1] = -1e30f;
        image.f32()[2] = std::numeric_limits<float>::quiet_NaN();
        image.f32()[3] = std::numeric_limits<float>::infinity();
        image.f32()[4] = 1e-42f;
        image.f32()[5] = -0.0f;
        ASSERT_TRUE(write_image(folder + "/a.exr", image));
        expect_same(back(folder + "/a.exr"), image);
    }
}

// The writer finds colours among other channels, in any order. Names and values are in the file.
TEST(write, exr_takes_channels_of_any_name)
{
    const std::string folder = test::temporary_folder();
    const Image image = gradient32(5);
    ASSERT_TRUE(write_channels(folder + "/a.exr", image, {"R", "G", "B", "Z", "N.X"}));
    ASSERT_TRUE(write_channels(folder + "/b.exr", image, {"R", "G", "B", "Z", "N.X"}));
    const Bytes bytes = test::bytes_of(folder + "/a.exr");
    EXPECT_EQ(bytes, test::bytes_of(folder + "/b.exr"));
    const std::string text(bytes.begin(), bytes.end());
    EXPECT_NE(text.find(std::string("N.X\0\2", 5)), std::string::npos); // 2: float
    EXPECT_NE(text.find(std::string("Z\0\2", 3)), std::string::npos);
    const Image colours = back(folder + "/a.exr");
    ASSERT_EQ(colours.channels, 3);
    for (std::size_t p = 0; p < 13 * 7; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(colours.f32()[3 * p + c], image.f32()[5 * p + c]);
    EXPECT_FALSE(write_channels(folder + "/a.hdr", image, {"R", "G", "B", "Z", "N.X"}));
}

TEST(write, pfm_and_png_and_tiff_keep_every_bit)
{
    const std::string folder = test::temporary_folder();
    for (const int channels : {1, 3}) {
        ASSERT_TRUE(write_image(folder + "/a.pfm", gradient32(channels)));
        expect_same(back(folder + "/a.pfm"), gradient32(channels));
    }
    for (const int channels : {1, 2, 3, 4}) {
        ASSERT_TRUE(write_image(folder + "/a.png", gradient8(channels)));
        expect_same(back(folder + "/a.png"), gradient8(channels));
        ASSERT_TRUE(write_image(folder + "/a.tif", gradient8(channels)));
        expect_same(back(folder + "/a.tif"), gradient8(channels));
    }
}

TEST(write, radiance_is_within_its_precision)
{
    const std::string path = test::temporary_folder() + "/a.hdr";
    Image image = gradient32(3);
    image.f32()[0] = 1e30f;
    image.f32()[1] = 0.0f;
    image.f32()[2] = -5.0f;
    image.f32()[3] = std::numeric_limits<float>::quiet_NaN();
    image.f32()[4] = std::numeric_limits<float>::infinity();
    ASSERT_TRUE(write_image(path, image));
    const Image read = back(path);
    ASSERT_EQ(read.bytes.size(), image.bytes.size());
    for (std::size_t i = 6; i < image.bytes.size() / 4; ++i) {
        const std::size_t pixel = i / 3 * 3;
        const float peak = std::max({image.f32()[pixel], image.f32()[pixel + 1], image.f32()[pixel + 2]});
        EXPECT_NEAR(read.f32()[i], image.f32()[i], peak / 128) << i;
    }
    EXPECT_NEAR(read.f32()[0], 1e30f, 1e28f);
    EXPECT_EQ(read.f32()[2], 0.0f);
    EXPECT_EQ(read.f32()[3], 0.0f);
    EXPECT_GT(read.f32()[4], 1e38f);
}

TEST(write, jpeg_is_near)
{
    const std::string path = test::temporary_folder() + "/a.jpeg";
    Image image = make_image(16, 16, 4, PixelType::u8);
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
        image.bytes[i] = static_cast<std::byte>(i % 4 == 3 ? 0 : 40 + 60 * (i % 4));
    ASSERT_TRUE(write_image(path, image));
    const Image read = back(path);
    ASSERT_EQ(read.channels, 3); // JPEG has no alpha
    for (std::size_t i = 0; i < read.bytes.size(); ++i)
        EXPECT_NEAR(static_cast<int>(read.bytes[i]), 40 + 60 * static_cast<int>(i % 3), 4) << i;
}

TEST(write, radiance_of_gray_is_rgb)
{
    const std::string path = test::temporary_folder() + "/a.hdr";
    Image image = make_image(1, 1, 2, PixelType::f32);
    image.f32()[0] = 0.5f;
    ASSERT_TRUE(write_image(path, image));
    const Image read = back(path);
    ASSERT_EQ(read.channels, 3);
    EXPECT_EQ(read.f32()[0], 0.5f);
    EXPECT_EQ(read.f32()[2], 0.5f);
}

std::vector<std::string> exr_attribute_names(const Bytes& file)
{
    std::vector<std::string> names;
    const char* at = reinterpret_cast<const char*>(file.data()) + 8;
    while (*at) {
        names.emplace_back(at);
        at += names.back().size() + 1;
        at += std::strlen(at) + 1;
        std::int32_t size = 0;
        std::memcpy(&size, at, 4);
        at += 4 + size;
    }
    return names;
}

TEST(write, exr_header_holds_nothing_volatile)
{
    const std::string path = test::temporary_folder() + "/a.exr";
    ASSERT_TRUE(write_image(path, gradient32(4)));
    EXPECT_EQ(exr_attribute_names(test::bytes_of(path)),
              (std::vector<std::string>{"channels", "chromaticities", "compression", "dataWindow", "displayWindow", "lineOrder",
                                        "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth"}));
}

TEST(write, png_is_marked_as_srgb_and_holds_no_more)
{
    const std::string path = test::temporary_folder() + "/a.png";
    ASSERT_TRUE(write_image(path, gradient8(4)));
    const Bytes file = test::bytes_of(path);
    std::vector<std::string> chunks;
    std::size_t at = 8;
    for (std::size_t size = 0; at + 12 <= file.size(); at += 12 + size) {
        size = static_cast<std::size_t>(file[at]) << 24 | static_cast<std::size_t>(file[at + 1]) << 16 |
               static_cast<std::size_t>(file[at + 2]) << 8 | file[at + 3];
        chunks.emplace_back(file.begin() + static_cast<std::ptrdiff_t>(at) + 4, file.begin() + static_cast<std::ptrdiff_t>(at) + 8);
        if (chunks.back() == "gAMA") { // 1/2.2 in units of 1/100000, as the standard recommends with sRGB
            EXPECT_EQ(file[at + 10] << 8 | file[at + 11], 45455);
        }
    }
    EXPECT_EQ(at, file.size());
    EXPECT_EQ(chunks, (std::vector<std::string>{"IHDR", "gAMA", "sRGB", "cHRM", "IDAT", "IEND"}));
}

TEST(write, png_errors_come_back)
{
    const std::string folder = test::temporary_folder();
    const Status status = write_image(folder + "/a.png", make_image(1000001, 1, 1, PixelType::u8)); // libpng's limit is a million
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ExitCode::output_failed);
    EXPECT_NE(status.error().reason.find("cannot be encoded: "), std::string::npos) << status.error().reason;
    EXPECT_TRUE(test::names_in(folder).empty());
}

// Writes a picture by parts of some rows.
void stream(const std::string& path, const Image& image, int part, int tile = 0)
{
    Result<std::unique_ptr<ImageStream>> stream = open_image_stream(path, {image.width, image.height, image.channels, {}, tile});
    ASSERT_TRUE(stream) << stream.error().line();
    const std::size_t row = image.bytes.size() / static_cast<std::size_t>(image.height);
    for (int y = 0; y < image.height; y += part) {
        EXPECT_FALSE(fs::exists(path)) << "it has its name before it is complete";
        Image rows = make_image(image.width, std::min(part, image.height - y), image.channels, image.type);
        std::memcpy(rows.bytes.data(), image.bytes.data() + static_cast<std::size_t>(y) * row, rows.bytes.size());
        const Status added = (*stream)->add(rows);
        ASSERT_TRUE(added) << added.error().line();
    }
    const Status finished = (*stream)->finish();
    ASSERT_TRUE(finished) << finished.error().line();
}

TEST(write, rows_make_the_bytes_of_whole_pictures)
{
    const std::string folder = test::temporary_folder();
    for (const int channels : {3, 4})
        for (const bool floats : {false, true}) {
            Image image = make_image(70, 53, channels, floats ? PixelType::f32 : PixelType::u8);
            for (std::size_t i = 0; i < image.bytes.size() / pixel_type_bytes(image.type); ++i)
                if (floats)
                    image.f32()[i] = static_cast<float>(i % 977) * 0.37f;
                else
                    image.bytes[i] = static_cast<std::byte>(i * 7 + i / 5);
            const std::string ending = floats ? ".exr" : ".png", whole = folder + "/whole" + ending, rows = folder + "/rows" + ending;
            ASSERT_TRUE(write_image(whole, image));
            fs::remove(rows);
            stream(rows, image, 16);
            EXPECT_TRUE(*read_file(rows, 1u << 24) == *read_file(whole, 1u << 24)) << ending << channels;
            if (!floats)
                continue;
            const std::string tiles = folder + "/tiles.exr";
            fs::remove(tiles);
            stream(tiles, image, 32, 32);
            const Image read = back(tiles);
            ASSERT_EQ(read.bytes.size(), image.bytes.size());
            EXPECT_EQ(std::memcmp(read.bytes.data(), image.bytes.data(), image.bytes.size()), 0);
        }
}

TEST(write, rows_that_end_early_leave_nothing)
{
    const std::string folder = test::temporary_folder();
    for (const std::string name : {"/a.exr", "/a.png"}) {
        const Image half = make_image(32, 16, 3, name == "/a.exr" ? PixelType::f32 : PixelType::u8);
        for (const bool finishes : {false, true}) {
            Result<std::unique_ptr<ImageStream>> stream = open_image_stream(folder + name, {32, 32, 3, {}, 0});
            ASSERT_TRUE(stream);
            ASSERT_TRUE((*stream)->add(half));
            if (finishes) {
                EXPECT_FALSE((*stream)->finish()) << name << " lacks rows";
            }
        }
        Result<std::unique_ptr<ImageStream>> stream = open_image_stream(folder + name, {32, 24, 3, {}, 0});
        ASSERT_TRUE(stream && (*stream)->add(half));
        EXPECT_FALSE((*stream)->add(half)) << name << " takes more rows than the picture has";
    }
    EXPECT_TRUE(test::names_in(folder).empty());
    for (const std::string& path : {folder + "/a.hdr", folder + "/none/a.png", std::string("/dev/null"), folder})
        EXPECT_FALSE(open_image_stream(path, {32, 32, 3, {}, 0})) << path;
}

TEST(write, repeated_files_are_the_same_bytes)
{
    const std::string folder = test::temporary_folder();
    std::vector<std::pair<std::string, Bytes>> first;
    for (const char* extension : {"exr", "hdr", "pfm", "png", "jpg", "tif"}) {
        const std::string path = folder + "/first." + extension;
        ASSERT_TRUE(write_image(path, stores_floats(path) ? gradient32(3) : gradient8(3)));
        first.emplace_back(extension, test::bytes_of(path));
        const std::string text(first.back().second.begin(), first.back().second.end());
        for (const char* word : {"OpenImageIO", "OpenEXR", "202", "/tmp", "burnish_image", "Software"})
            EXPECT_EQ(text.find(word), std::string::npos) << extension << " " << word;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // a stored time of day would differ
    for (const auto& [extension, bytes] : first) {
        const std::string path = folder + "/another_name." + extension;
        ASSERT_TRUE(write_image(path, stores_floats(path) ? gradient32(3) : gradient8(3)));
        EXPECT_TRUE(test::bytes_of(path) == bytes) << extension;
    }
}

TEST(write, extension_decides_about_floats)
{
    for (const char* path : {"a.exr", "A.EXR", "b/c.hdr", "d.pfm"})
        EXPECT_TRUE(stores_floats(path)) << path;
    for (const char* path : {"a.png", "a.jpg", "a.tif", "exr", "a.exr/b", "", "a.exr.png"})
        EXPECT_FALSE(stores_floats(path)) << path;
}

Error failure(const Status& status)
{
    EXPECT_FALSE(status);
    if (status)
        return {ExitCode::ok, "", "", ""};
    EXPECT_EQ(status.error().code, ExitCode::output_failed);
    EXPECT_FALSE(status.error().reason.empty());
    return status.error();
}

TEST(write, impossible_outputs_are_clear_errors)
{
    const std::string folder = test::temporary_folder();
    const Image floats = gradient32(3);
    EXPECT_EQ(failure(write_image(folder + "/no/a.exr", floats)).reason, "cannot be written: its folder does not exist");
    fs::create_directory(folder + "/dir.exr");
    EXPECT_NE(failure(write_image(folder + "/dir.exr", floats)).reason.find("directory"), std::string::npos);
    failure(write_image(folder + "/a.png", floats));
    failure(write_image(folder + "/a.exr", gradient8(3)));
    failure(write_image(folder + "/a.gif", gradient8(3)));
    failure(write_image(folder + "/a", gradient8(3)));
    failure(write_file(folder, "x"));
    if (fs::exists("/dev/full")) {
        failure(write_file("/dev/full", "x"));
    }
    EXPECT_EQ(test::names_in(folder), (std::vector<std::string>{"dir.exr"}));
}

TEST(write, folder_without_permission_is_an_error)
{
    if (geteuid() == 0)
        GTEST_SKIP() << "root may write everywhere";
    const std::string folder = test::temporary_folder();
    ASSERT_EQ(chmod(folder.c_str(), 0500), 0);
    EXPECT_NE(failure(write_image(folder + "/a.exr", gradient32(3))).reason.find("ermission"), std::string::npos);
    ASSERT_EQ(chmod(folder.c_str(), 0700), 0);
}

// Runs `body` in a process whose files may not exceed 4 KiB, like on a disk that becomes full.
template <class Body> int with_full_disk(Body body)
{
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{4096, 4096};
        setrlimit(RLIMIT_FSIZE, &limit);
        const Status status = body();
        const bool good = !status && status.error().code == ExitCode::output_failed &&
                          status.error().reason.find("cannot be written") != std::string::npos;
        _exit(good ? 0 : 1);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status;
}

TEST(write, full_disk_leaves_the_old_file_or_none)
{
    const std::string folder = test::temporary_folder();
    Image noise = make_image(64, 64, 3, PixelType::f32);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < noise.bytes.size() / 4; ++i)
        noise.f32()[i] = static_cast<float>(state = state * 1664525u + 1013904223u);
    for (const char* name : {"/a.exr", "/a.hdr", "/a.pfm"})
        EXPECT_EQ(with_full_disk([&] { return write_image(folder + name, noise); }), 0) << name;
    EXPECT_EQ(with_full_disk([&] { return write_file(folder + "/a.json", std::string(10000, 'x')); }), 0);
    EXPECT_TRUE(test::names_in(folder).empty());
    ASSERT_TRUE(write_file(folder + "/a.exr", "old"));
    EXPECT_EQ(with_full_disk([&] { return write_image(folder + "/a.exr", noise); }), 0);
    EXPECT_EQ(test::names_in(folder), (std::vector<std::string>{"a.exr"}));
    EXPECT_EQ(test::bytes_of(folder + "/a.exr"), (Bytes{'o', 'l', 'd'}));
}

TEST(write, success_replaces_and_leaves_nothing_else)
{
    const std::string folder = test::temporary_folder();
    ASSERT_TRUE(write_file(folder + "/a.png", "old"));
    fs::create_symlink("a.png", folder + "/link.png");
    ASSERT_TRUE(write_image(folder + "/link.png", gradient8(3)));
    EXPECT_TRUE(fs::is_symlink(folder + "/link.png"));
    expect_same(back(folder + "/a.png"), gradient8(3));
    EXPECT_EQ(test::names_in(folder), (std::vector<std::string>{"a.png", "link.png"}));
    EXPECT_TRUE(write_image("/dev/null", gradient8(3)) ? false : true); // no extension: refused
    EXPECT_TRUE(write_file("/dev/null", "x"));                          // devices are written directly
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

} // namespace
} // namespace burnish
