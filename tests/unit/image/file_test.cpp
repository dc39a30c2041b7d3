#include "core/base/file.h"

#include <gtest/gtest.h>

#include "small_files.h"

namespace burnish {
namespace {

TEST(file, what_is_written_is_read)
{
    const std::string path = test::temporary_folder() + "/a.bin";
    const test::Bytes bytes{0, 1, 2, 255, 10};
    ASSERT_TRUE(write_file_atomic(path, bytes.data(), bytes.size()));
    const Result<test::Bytes> read = read_file(path, 5);
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, bytes);
    const Result<test::Bytes> refused = read_file(path, 4);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().line(), path + ": has 5 bytes, more than the limit of 4");
}

TEST(file, long_names_can_be_written)
{
    const std::string path = test::temporary_folder() + "/" + std::string(250, 'n');
    EXPECT_TRUE(write_file_atomic(path, "x", 1));
}

} // namespace
} // namespace burnish
