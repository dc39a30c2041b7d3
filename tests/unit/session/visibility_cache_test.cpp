// The cache of the sky's visibility: what it refuses.
#include "raster/session/visibility_cache.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <unistd.h>

namespace burnish {
namespace {

constexpr std::uint64_t kHash = 0x0123456789abcdefull;

std::string own_path()
{
    return (std::filesystem::path(testing::TempDir()) / ("sky_" + std::to_string(getpid()) + ".vis")).string();
}

TEST(visibility_cache, gives_back_what_was_kept_and_refuses_all_else)
{
    const std::string path = own_path();
    const std::vector<float> kept = {0.0f, 0.25f, 1.0f};
    EXPECT_FALSE(read_visibility_cache(path, kHash, 3));
    ASSERT_TRUE(write_visibility_cache(path, kHash, kept));
    EXPECT_EQ(read_visibility_cache(path, kHash, 3), kept);
    EXPECT_FALSE(read_visibility_cache(path, kHash + 1, 3)) << "another scene";
    EXPECT_FALSE(read_visibility_cache(path, kHash, 2)) << "another number of places";
    std::string bytes;
    {
        std::ifstream file(path, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ 4);
        std::ofstream(path, std::ios::binary) << damaged;
        EXPECT_FALSE(read_visibility_cache(path, kHash, 3)) << "byte " << i;
    }
    for (const float wrong : {-0.5f, 1.5f, std::nanf(""), INFINITY}) { // with correct checksums
        ASSERT_TRUE(write_visibility_cache(path, kHash, {0.0f, wrong, 1.0f}));
        EXPECT_FALSE(read_visibility_cache(path, kHash, 3)) << wrong;
    }
    std::filesystem::remove(path);
}

} // namespace
} // namespace burnish
