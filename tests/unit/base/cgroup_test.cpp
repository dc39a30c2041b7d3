// Limits by control groups, read from folders with Linux's layout.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

#include "core/base/cgroup.h"

using namespace burnish;
namespace fs = std::filesystem;

namespace {

class cgroup : public testing::Test {
  protected:
    void SetUp() override
    {
        char name[] = "/tmp/burnish_cgroup_XXXXXX";
        root_ = ::mkdtemp(name);
    }
    void TearDown() override { fs::remove_all(root_); }
    void put(const std::string& file, const std::string& text)
    {
        fs::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text;
    }
    std::uint64_t limit() const { return cgroup_memory_limit((root_ / "proc").string(), (root_ / "sys").string()); }

    fs::path root_;
};

} // namespace

TEST_F(cgroup, without_files_there_is_no_limit)
{
    EXPECT_EQ(limit(), 0u);
    put("proc", "nonsense\n::\n0::/\n");
    put("sys/memory.max", "max\n");
    EXPECT_EQ(limit(), 0u);
}

TEST_F(cgroup, memory_is_the_machine_s_or_the_group_s)
{
    const std::string proc = (root_ / "proc").string(), sys = (root_ / "sys").string();
    const std::uint64_t machine = usable_memory(proc, sys);
    EXPECT_EQ(machine, static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)));
    put("proc", "0::/\n");
    put("sys/memory.max", "3000000\n");
    EXPECT_EQ(usable_memory(proc, sys), 3000000u);
    put("sys/memory.max", std::to_string(4 * machine) + "\n");
    EXPECT_EQ(usable_memory(proc, sys), machine);
}

TEST_F(cgroup, of_version_2_the_tightest_around_counts)
{
    put("proc", "0::/system.slice/job\n");
    put("sys/system.slice/job/memory.max", "4000000\n");
    put("sys/system.slice/memory.max", "3000000\n");
    put("sys/memory.max", "max\n");
    EXPECT_EQ(limit(), 3000000u);
}

TEST_F(cgroup, of_version_1_the_controller_has_a_folder)
{
    put("proc", "9:name=systemd:/\n4:cpu,memory:/a/b\n0::/\n");
    put("sys/memory/a/b/memory.limit_in_bytes", "9223372036854771712\n");
    put("sys/memory/a/memory.limit_in_bytes", "5000000\n");
    EXPECT_EQ(limit(), 5000000u);
}

TEST_F(cgroup, in_a_container_the_root_is_the_own_group)
{
    put("proc", "4:memory:/docker/0123\n");
    put("sys/memory/memory.limit_in_bytes", "6000000\n");
    EXPECT_EQ(limit(), 6000000u);
}
