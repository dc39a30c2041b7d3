#include "core/base/column.h"

#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace burnish {
namespace {

void expect_padded(const Column<int>& column)
{
    for (std::size_t i = 0; i < kColumnPad; ++i)
        EXPECT_EQ(column.data()[column.size() + i], 0) << "size " << column.size() << ", past the end by " << i;
}

TEST(column, reads_zeroes_past_its_end)
{
    Column<int> column;
    for (int i = 1; i <= 300; ++i) {
        column.push_back(i);
        expect_padded(column);
    }
    for (const std::size_t size : {std::size_t{299}, std::size_t{3}, std::size_t{4}, std::size_t{40}, std::size_t{900}, std::size_t{0}}) {
        const std::size_t before = column.size();
        column.resize(size);
        expect_padded(column);
        for (std::size_t i = before; i < size; ++i)
            EXPECT_EQ(column[i], 0);
    }
    column.push_back(7);
    expect_padded(column);
    const Column<int> copy(column);
    EXPECT_EQ(copy[0], 7);
    expect_padded(copy);
}

TEST(column, keeps_no_element_of_a_longer_time)
{
    Column<int> column(100);
    for (std::size_t i = 0; i < column.size(); ++i)
        column[i] = 9;
    column.resize(10); // the other ninety stay in memory
    for (int i = 0; i < 80; ++i) {
        column.push_back(1);
        expect_padded(column);
    }
    column.resize(10);
    column.resize(100);
    for (std::size_t i = 10; i < column.size(); ++i)
        EXPECT_EQ(column[i], 0);
}

std::size_t resident_bytes()
{
    std::size_t all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(column, owns_no_pages_for_spare_room)
{
    const std::size_t before = resident_bytes();
    if (before == 0)
        GTEST_SKIP() << "this system does not tell a process its memory";
    Column<int> column;
    column.reserve(std::size_t{64} << 20); // 256 MB
    column.push_back(1);
    EXPECT_LT(resident_bytes(), before + (std::size_t{64} << 20));
}

} // namespace
} // namespace burnish
