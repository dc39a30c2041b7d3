#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>

#include "core/image/io/image_io.h"
#include "core/image/io/png_write.h"
#include "core/jobs/control.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A picture of several segments, with runs, ramps and noise.
Image large_picture(int width, int height, int channels)
{
    Image image = make_image(width, height, channels, PixelType::u8);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < image.bytes.size(); ++i) {
        state = state * 1664525u + 1013904223u;
        image.bytes[i] = static_cast<std::byte>(i / 5000 % 3 == 0   ? 7u
                                                : i / 5000 % 3 == 1 ? static_cast<std::uint32_t>(i / 11)
                                                                    : state >> 24);
    }
    return image;
}

Image rows_of(const Image& image, int first, int count)
{
    Image rows = make_image(image.width, count, image.channels, image.type);
    const std::size_t row = image.bytes.size() / static_cast<std::size_t>(image.height);
    std::copy_n(image.bytes.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * row), rows.bytes.size(),
                rows.bytes.begin());
    return rows;
}

TEST(png_write, bytes_do_not_depend_on_threads_and_on_how_rows_are_split)
{
    const Jobs jobs(4);
    for (const int channels : {1, 2, 3, 4}) {
        const Image image = large_picture(1023, 700, channels);
        const Result<Bytes> one = png_bytes("a.png", image), four = png_bytes("a.png", image, &jobs);
        ASSERT_TRUE(one && four);
        EXPECT_EQ(*one, *four) << channels;
        PngEncoder encoder("a.png");
        Bytes by_rows;
        const auto put = [&](const Result<Bytes>& more) {
            ASSERT_TRUE(more);
            by_rows.insert(by_rows.end(), more->begin(), more->end());
        };
        put(encoder.begin(image.width, image.height, channels));
        for (int y = 0, count = 1; y < image.height; y += count, count = std::min(2 * count + 1, image.height - y))
            put(encoder.rows(rows_of(image, y, count), y % 2 ? &jobs : nullptr));
        put(encoder.end());
        EXPECT_EQ(*one, by_rows) << channels;
        // libpng reads the picture back
        const Result<Image> read = decode_image(one->data(), one->size(), "a.png", {});
        ASSERT_TRUE(read) << read.error().reason;
        EXPECT_EQ(read->channels, channels);
        EXPECT_EQ(read->bytes, image.bytes) << channels;
    }
}

TEST(png_write, the_smallest_and_the_widest_pictures_are_read_back)
{
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 3000), std::pair(3, 1), std::pair(16384, 5)}) {
        const Image image = large_picture(width, height, 3);
        const Result<Bytes> bytes = png_bytes("a.png", image);
        ASSERT_TRUE(bytes);
        const Result<Image> read = decode_image(bytes->data(), bytes->size(), "a.png", {});
        ASSERT_TRUE(read) << width << " x " << height << ": " << read.error().reason;
        EXPECT_EQ(read->bytes, image.bytes) << width << " x " << height;
    }
}

TEST(png_write, a_stop_ends_the_work)
{
    const Image image = large_picture(1023, 700, 3);
    std::stop_source stop;
    stop.request_stop();
    const Controlled controlled({stop.get_token()});
    const Jobs jobs(2);
    EXPECT_THROW(static_cast<void>(png_bytes("a.png", image)), Stopped);
    EXPECT_THROW(static_cast<void>(png_bytes("a.png", image, &jobs)), Stopped);
}

} // namespace
} // namespace burnish
