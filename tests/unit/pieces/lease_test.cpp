// Leases: one owner at a time, and dead owners hold nobody.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "apps/pieces/lease.h"
#include "tests/unit/temp_folder.h"

namespace burnish::test {
namespace {

using namespace std::chrono_literals;

TEST(lease, has_one_owner)
{
    const TempFolder folder;
    const std::string file = folder.path("piece.lease");
    Leases one(new_process_name()), two(new_process_name());
    Result<std::unique_ptr<Lease>> first = one.take(file);
    ASSERT_TRUE(first && *first);
    const Result<std::unique_ptr<Lease>> second = two.take(file);
    ASSERT_TRUE(second);
    EXPECT_EQ(*second, nullptr);
    first->reset();
    EXPECT_FALSE(std::filesystem::exists(file));
    const Result<std::unique_ptr<Lease>> third = two.take(file);
    EXPECT_TRUE(third && *third);
}

TEST(lease, of_a_living_owner_stays)
{
    const TempFolder folder;
    const std::string file = folder.path("piece.lease");
    Leases one(new_process_name(), {5ms, 100ms}), two(new_process_name(), {5ms, 100ms});
    const Result<std::unique_ptr<Lease>> first = one.take(file);
    ASSERT_TRUE(first && *first);
    for (int i = 0; i < 15; ++i) { // longer than a dead owner has
        const Result<std::unique_ptr<Lease>> taken = two.take(file);
        ASSERT_TRUE(taken);
        ASSERT_EQ(*taken, nullptr);
        std::this_thread::sleep_for(20ms);
    }
}

TEST(lease, of_a_dead_owner_is_taken_over)
{
    const TempFolder folder;
    const std::string file = folder.path("piece.lease");
    std::ofstream(file) << "elsewhere 1 0000000000000000 12\n";
    Leases leases(new_process_name(), {5ms, 30ms});
    const Result<std::unique_ptr<Lease>> early = leases.take(file);
    ASSERT_TRUE(early);
    EXPECT_EQ(*early, nullptr);
    std::this_thread::sleep_for(60ms);
    const Result<std::unique_ptr<Lease>> late = leases.take(file);
    EXPECT_TRUE(late && *late);
}

TEST(lease, of_an_ended_process_of_this_machine_is_free)
{
    const TempFolder folder;
    const std::string file = folder.path("piece.lease");
    char host[256] = {};
    ASSERT_EQ(::gethostname(host, sizeof host - 1), 0);
    const pid_t child = ::fork();
    if (child == 0)
        ::_exit(0);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const std::string numbers = std::filesystem::read_symlink("/proc/self/ns/pid").string();
    std::ofstream(file) << host << "/" << numbers << " " << child << " 0000000000000000 3\n";
    Leases leases(new_process_name());
    const Result<std::unique_ptr<Lease>> lease = leases.take(file);
    EXPECT_TRUE(lease && *lease);
}

TEST(lease, that_was_taken_over_is_left_to_its_new_owner)
{
    const TempFolder folder;
    const std::string file = folder.path("piece.lease");
    Leases leases(new_process_name(), {5ms, 30ms});
    {
        const Result<std::unique_ptr<Lease>> lease = leases.take(file);
        ASSERT_TRUE(lease && *lease);
        std::filesystem::remove(file);
        std::ofstream(file) << "elsewhere 1 0000000000000000 0\n";
        std::this_thread::sleep_for(20ms);
    }
    EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(lease, in_a_folder_that_is_not_there_is_an_error)
{
    const TempFolder folder;
    Leases leases(new_process_name());
    const Result<std::unique_ptr<Lease>> lease = leases.take(folder.path("none/piece.lease"));
    ASSERT_FALSE(lease);
    EXPECT_EQ(lease.error().code, ExitCode::output_failed);
}

} // namespace
} // namespace burnish::test
