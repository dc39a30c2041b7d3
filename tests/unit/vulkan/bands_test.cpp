// Large images: rows of bands, indices within 32 bits.
#include <gtest/gtest.h>

#include <climits>

#include "raster/vulkan/bands.h"

namespace burnish::test {
namespace {

TEST(bands, cover_every_row_once)
{
    for (int height : {1, 2, 7, 64, 8192})
        for (int rows : {2, 6, 8192}) {
            int next = 0;
            for (const Band& band : bands_of(height, rows)) {
                EXPECT_EQ(band.first_row, next);
                EXPECT_GT(band.rows, 0);
                EXPECT_LE(band.rows, rows);
                next += band.rows;
            }
            EXPECT_EQ(next, height);
        }
}

TEST(bands, fit_whatever_the_picture)
{
    for (int width : {1, 3, 1920, 8192, 16384})
        for (std::size_t bytes : {std::size_t{12}, std::size_t{8 * 57 * 4}, kMostBytesAPixel}) {
            const int rows = band_rows(width, 16384, bytes, kBandBytes);
            EXPECT_GE(rows, 2);
            EXPECT_EQ(rows % 2, 0) << "quads of a device must not be cut";
            const std::size_t used = static_cast<std::size_t>(width) * static_cast<std::size_t>(rows) * bytes;
            EXPECT_LE(used, kBandBytes);
            EXPECT_LE(used, static_cast<std::size_t>(INT_MAX)) << "indices of words";
        }
    EXPECT_EQ(band_rows(1920, 1080, 16, kBandBytes), 1080) << "one band";
    EXPECT_EQ(band_rows(4, 1, 16, kBandBytes), 2);
}

} // namespace
} // namespace burnish::test
