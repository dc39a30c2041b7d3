// Long silent work is reported on stderr; a library reports nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <unistd.h>

#include "core/jobs/activity.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

// Runs `body` as reported work. The interval is read once a process, so each death test uses a new process and matches stderr.
void work(bool told, const std::function<void()>& body)
{
    setenv("BURNISH_PROGRESS_SECONDS", "0.1", 1);
    Activity::tell(told);
    {
        const Activity outer("parity"), inner("compiling shade");
        body();
    }
    std::fprintf(stderr, "end\n");
    std::_Exit(0);
}

void sleep_ms(int ms)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

TEST(activity, long_work_is_told_with_what_it_is_part_of)
{
    EXPECT_EXIT(work(true, [] { sleep_ms(600); }), testing::ExitedWithCode(0),
                "^parity, compiling shade: [0-9]+ s\nparity, compiling shade: [0-9]+ s\n(parity, compiling shade: [0-9]+ s\n)*end\n$");
}

TEST(activity, short_work_and_libraries_say_nothing)
{
    EXPECT_EXIT(work(true, [] {}), testing::ExitedWithCode(0), "^end\n$");
    EXPECT_EXIT(work(false, [] { sleep_ms(600); }), testing::ExitedWithCode(0), "^end\n$");
}

TEST(activity, progress_without_steps_is_told_by_its_share)
{
    EXPECT_EXIT(work(true,
                     [] {
                         Progress progress("rows", 4, false);
                         progress.step();
                         sleep_ms(600);
                     }),
                testing::ExitedWithCode(0), "^(rows: 25 %[^\n]*\n)+end\n$");
}

TEST(activity, what_ended_is_not_told)
{
    EXPECT_EXIT(work(true,
                     [] {
                         {
                             const Activity gone("reading");
                         }
                         sleep_ms(300);
                     }),
                testing::ExitedWithCode(0), "^(parity, compiling shade: [0-9]+ s\n)+end\n$");
}

} // namespace
} // namespace burnish
