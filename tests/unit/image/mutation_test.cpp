// Random damage to small valid files never crashes the reader. The reader returns an image or an Error.
#include <gtest/gtest.h>

#include <cstring>

#include "core/image/io/image_io.h"
#include "small_files.h"

namespace burnish {
namespace {

using test::Bytes;

struct Random { // Knuth's 64-bit linear congruential generator
    std::uint64_t state;
    std::size_t below(std::size_t n)
    {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        return static_cast<std::size_t>((state >> 33) % n);
    }
};

void damage(Bytes& bytes, Random& random)
{
    const std::size_t edits = 1 + random.below(6);
    for (std::size_t i = 0; i < edits && !bytes.empty(); ++i) {
        const std::size_t at = random.below(bytes.size());
        switch (random.below(6)) {
        case 0:
            bytes[at] = static_cast<std::uint8_t>(random.below(256));
            break;
        case 1:
            bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u << random.below(8)));
            break;
        case 2:
            std::memset(bytes.data() + at, random.below(2) ? 0xFF : 0x00, std::min<std::size_t>(4, bytes.size() - at));
            break;
        case 3:
            bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
            break;
        case 4:
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), static_cast<std::uint8_t>(random.below(256)));
            break;
        default:
            if (random.below(4) == 0)
                bytes.resize(at);
        }
    }
}

Image noise(int channels, PixelType type)
{
    Image image = make_image(17, 9, channels, type);
    Random random{42};
    if (type == PixelType::u8)
        for (std::byte& b : image.bytes)
            b = static_cast<std::byte>(random.below(256));
    else
        for (std::size_t i = 0; i < image.bytes.size() / 4; ++i)
            image.f32()[i] = static_cast<float>(random.below(1000)) * 0.01f;
    return image;
}

void survive(const Bytes& sound, int rounds, std::uint64_t seed)
{
#ifdef BN_SANITIZED // thirty times slower
    rounds /= 8;
#endif
    Limits limits;
    limits.image_side = 512;
    Random random{seed};
    int refused = 0;
    testing::internal::CaptureStderr();
    for (int i = 0; i < rounds; ++i) {
        Bytes bytes = sound;
        damage(bytes, random);
        const Result<Image> image = decode_image(bytes.data(), bytes.size(), "label", limits);
        if (!image) {
            ++refused;
            ASSERT_FALSE(image.error().reason.empty());
            ASSERT_EQ(image.error().code, ExitCode::bad_input);
        } else {
            ASSERT_EQ(image->bytes.size(),
                      static_cast<std::size_t>(image->width * image->height * image->channels) * pixel_type_bytes(image->type));
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), ""); // errors are returned, never printed
    EXPECT_GT(refused, 0);                                 // the damage reaches the readers
}

Bytes written(const std::string& name, const Image& image)
{
    const std::string path = test::temporary_folder() + "/" + name;
    const Status status = write_image(path, image);
    EXPECT_TRUE(status) << status.error().line();
    return test::bytes_of(path);
}

TEST(mutation, png_survives)
{
    survive(written("a.png", noise(4, PixelType::u8)), 1500, 1);
}

TEST(mutation, jpeg_survives)
{
    survive(written("a.jpg", noise(3, PixelType::u8)), 1500, 2);
}

TEST(mutation, exr_survives)
{
    survive(written("a.exr", noise(3, PixelType::f32)), 1500, 3);
}

TEST(mutation, radiance_survives)
{
    survive(written("a.hdr", noise(3, PixelType::f32)), 1500, 4);
}

TEST(mutation, pfm_and_tiff_survive)
{
    survive(written("a.pfm", noise(3, PixelType::f32)), 500, 5);
    survive(written("a.tif", noise(3, PixelType::u8)), 500, 6);
}

TEST(mutation, uncompressed_multi_part_exr_survives)
{
    test::ExrPart flat{{{"B", 1, 3}, {"G", 1, 2}, {"R", 1, 1}}, {0, 0, 7, 3}, {-1, 0, 8, 4}, "scanlineimage"};
    test::ExrPart deep{{{"Z", 2, 0}}, {0, 0, 1, 1}, {0, 0, 1, 1}, "deepscanline"};
    survive(test::make_exr({flat, flat}), 1000, 7);
    survive(test::make_exr({deep, flat}), 500, 8);
}

} // namespace
} // namespace burnish
