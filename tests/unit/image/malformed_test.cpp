// Bad input: every file ends in one clear Error, in bounded time and memory.
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "core/image/io/image_io.h"
#include "small_files.h"
#include "tests/unit/data.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;
using test::Bytes;

Error refusal(const Bytes& bytes, const Limits& limits = {})
{
    const Result<Image> image = decode_image(bytes.data(), bytes.size(), "label", limits);
    EXPECT_FALSE(image);
    if (image)
        return {ExitCode::ok, "", "", ""};
    EXPECT_EQ(image.error().code, ExitCode::bad_input);
    EXPECT_EQ(image.error().file, "label");
    EXPECT_FALSE(image.error().reason.empty());
    return image.error();
}

Error refusal_of_path(const std::string& path, const Limits& limits = {})
{
    const Result<Image> image = read_image(path, limits);
    EXPECT_FALSE(image) << path;
    if (image)
        return {ExitCode::ok, "", "", ""};
    EXPECT_EQ(image.error().file, path);
    EXPECT_EQ(image.error().code, ExitCode::bad_input);
    EXPECT_FALSE(image.error().reason.empty());
    return image.error();
}

Bytes cut(Bytes bytes, std::size_t size)
{
    bytes.resize(size);
    return bytes;
}

struct ChildEnd {
    int status = 0;
    long peak_kib = 0;
    double cpu_seconds = 0.0; // other programs do not lengthen it
};

// Runs `read_image` in a separate process with 2 GiB of address space. The exit status is 0 for a good refusal.
ChildEnd refuse_in_child(const std::string& path)
{
    const pid_t child = fork();
    if (child == 0) {
#ifndef BN_SANITIZED // sanitizers reserve terabytes
        const rlimit two_gib{2ull << 30, 2ull << 30};
        setrlimit(RLIMIT_AS, &two_gib);
#endif
        alarm(60);
        const Result<Image> image = read_image(path, Limits{});
        _exit(!image && image.error().code == ExitCode::bad_input && !image.error().reason.empty() ? 0 : 1);
    }
    ChildEnd end;
    rusage usage{};
    wait4(child, &end.status, 0, &usage);
    end.peak_kib = usage.ru_maxrss;
    for (const timeval& t : {usage.ru_utime, usage.ru_stime})
        end.cpu_seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    return end;
}

TEST(malformed, every_shared_file_is_refused_in_little_time_and_memory)
{
    int files = 0;
    for (const char* folder : {"malformed/exr", "malformed/hdr", "malformed/png", "malformed/image"})
        for (const std::string& path : test::data_files(folder)) {
            if (fs::path(path).extension() == ".gltf")
                continue;
            const ChildEnd end = refuse_in_child(path);
            EXPECT_EQ(end.status, 0) << path;
            EXPECT_LT(end.cpu_seconds, 2.0) << path;
#ifndef BN_SANITIZED
            EXPECT_LT(end.peak_kib, 200 * 1024) << path;
#endif
            refusal_of_path(path);
            ++files;
        }
    EXPECT_GE(files, 10);
}

TEST(malformed, errors_say_where)
{
    const std::string data = BN_TEST_DATA "/malformed";
    EXPECT_EQ(refusal_of_path(data + "/png/bomb_60000x60000.png").place, "header: width 60000");
    EXPECT_EQ(refusal_of_path(data + "/hdr/huge_dims.hdr").place, "header: width 2147483647");
    EXPECT_EQ(refusal_of_path(data + "/hdr/truncated.hdr").place, "byte 40000");
    EXPECT_EQ(refusal_of_path(data + "/image/invalid_image_data.jpg").place, "byte 16");
    EXPECT_EQ(refusal_of_path(data + "/exr/truncated.exr").place, "byte 50000");
}

TEST(malformed, paths_that_are_no_files_are_named)
{
    const std::string folder = test::temporary_folder();
    EXPECT_NE(refusal_of_path(folder + "/missing.png").reason.find("No such file"), std::string::npos);
    EXPECT_EQ(refusal_of_path(folder).reason, "is a folder, not a file");
    test::put(folder + "/empty.png", {});
    EXPECT_EQ(refusal_of_path(folder + "/empty.png").reason, "is empty");
    ASSERT_EQ(mkfifo((folder + "/pipe.png").c_str(), 0600), 0);
    EXPECT_EQ(refusal_of_path(folder + "/pipe.png").reason, "is not a regular file"); // and does not hang
    test::put(folder + "/text.png", Bytes(100, 'x'));
    EXPECT_EQ(refusal_of_path(folder + "/text.png").place, "byte 0");
    Limits small;
    small.file_bytes = 99;
    EXPECT_NE(refusal_of_path(folder + "/text.png", small).reason.find("limit of 99"), std::string::npos);
}

TEST(malformed, limits_decide)
{
    const Bytes png = test::make_png(20, 1, 8, 0, std::string(20, 'x'));
    Limits limits;
    limits.image_side = 20;
    EXPECT_TRUE(decode_image(png.data(), png.size(), "label", limits));
    limits.image_side = 19;
    EXPECT_EQ(refusal(png, limits).place, "header: width 20");
    const Bytes tall = test::make_png(1, 20, 8, 0, std::string(20, 'x'));
    EXPECT_EQ(refusal(tall, limits).place, "header: height 20");
    limits.image_side = 20;
    limits.texture_bytes = 19;
    EXPECT_NE(refusal(png, limits).reason.find("limit of 19"), std::string::npos);
    limits.texture_bytes = 20;
    limits.file_bytes = png.size() - 1;
    refusal(png, limits);
}

TEST(malformed, a_small_png_cannot_claim_a_large_picture)
{
    Bytes png = test::make_png(1, 1, 8, 6, "abcd");
    png[18] = 0x3F; // 16129 pixels wide
    png[22] = 0x3F;
    EXPECT_NE(refusal(png).reason.find("cannot hold"), std::string::npos);
}

TEST(malformed, a_png_with_a_wrong_checksum_is_an_error)
{
    Bytes png = test::make_png(1, 1, 8, 6, "abcd");
    png[png.size() - 12 - 4 - 6] ^= 1; // in the pixels
    const Error error = refusal(png);
    EXPECT_EQ(error.place, "byte 33");
    EXPECT_NE(error.reason.find("checksum"), std::string::npos);
}

TEST(malformed, truncation_anywhere_is_an_error)
{
    test::ExrPart part{{{"B", 2, 3}, {"G", 2, 2}, {"R", 2, 1}}, {0, 0, 3, 2}, {0, 0, 3, 2}, ""};
    const Bytes exr = test::make_exr({part});
    const Bytes png = test::make_png(4, 3, 8, 2, std::string(36, 'p'));
    const Bytes hdr = test::make_hdr("-Y 3 +X 4", Bytes(48, 130));
    for (const Bytes* file : {&exr, &png, &hdr}) {
        for (std::size_t size = 0; size < file->size(); ++size)
            EXPECT_EQ(refusal(cut(*file, size)).code, ExitCode::bad_input) << size;
    }
}

TEST(malformed, a_jpeg_without_its_end_is_an_error)
{
    const std::string path = test::temporary_folder() + "/a.jpg";
    ASSERT_TRUE(write_image(path, make_image(32, 32, 3, PixelType::u8)));
    const Bytes jpeg = test::bytes_of(path);
    ASSERT_TRUE(decode_image(jpeg.data(), jpeg.size(), "label", Limits{}));
    for (std::size_t size = 0; size < jpeg.size(); ++size)
        refusal(cut(jpeg, size));
}

TEST(malformed, deep_exr_is_refused)
{
    test::ExrPart deep{{{"Z", 2, 0}}, {0, 0, 0, 0}, {0, 0, 0, 0}, "deepscanline"};
    EXPECT_NE(refusal(test::make_exr({deep})).reason.find("deep"), std::string::npos);
    EXPECT_NE(refusal(test::make_exr({deep, deep})).reason.find("deep"), std::string::npos);
}

TEST(malformed, exr_windows_are_bounded)
{
    test::ExrPart part{{{"Y", 2, 0}}, {0, 0, 0, 0}, {0, 0, 99999, 0}, ""};
    EXPECT_EQ(refusal(test::make_exr({part})).place, "header: width 100000");
    part.display[2] = -1;
    refusal(test::make_exr({part}));
    part.display[2] = 2147483647;
    refusal(test::make_exr({part}));
}

} // namespace
} // namespace burnish
