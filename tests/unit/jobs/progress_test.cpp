#include <gtest/gtest.h>

#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "core/jobs/jobs.h"

namespace burnish {
namespace {

// Returns the text that `body` prints while stderr is `fd`, read from `from` afterwards.
template <class Body> std::string printed(int fd, int from, Body body)
{
    std::fflush(stderr);
    const int saved = dup(STDERR_FILENO);
    dup2(fd, STDERR_FILENO);
    body();
    std::fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    fcntl(from, F_SETFL, O_NONBLOCK);
    std::string text;
    char buffer[4096];
    for (ssize_t n; (n = read(from, buffer, sizeof(buffer))) > 0;)
        text.append(buffer, static_cast<std::size_t>(n));
    return text;
}

template <class Body> std::string printed_on_terminal(Body body)
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY);
    EXPECT_GE(master, 0);
    EXPECT_EQ(grantpt(master), 0);
    EXPECT_EQ(unlockpt(master), 0);
    const int terminal = open(ptsname(master), O_RDWR | O_NOCTTY | O_NONBLOCK);
    EXPECT_GE(terminal, 0);
    const winsize size{24, 40, 0, 0};
    ioctl(terminal, TIOCSWINSZ, &size);
    const std::string text = printed(terminal, master, body);
    close(terminal);
    close(master);
    return text;
}

void work(bool quiet)
{
    Progress progress("a label that is rather long", 1000, quiet);
    for (int i = 0; i < 1000; ++i)
        progress.step();
}

TEST(progress, nothing_of_short_work_where_stderr_is_no_terminal)
{
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    EXPECT_EQ(printed(ends[1], ends[0], [] { work(false); }), "");
    close(ends[0]);
    close(ends[1]);
}

TEST(progress, a_line_now_and_then_where_stderr_is_no_terminal)
{
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    setenv("BURNISH_PROGRESS_SECONDS", "0.4", 1);
    const std::string text = printed(ends[1], ends[0], [] {
        Progress progress("bake", 100, false);
        for (int i = 0; i < 30; ++i) {
            progress.step();
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    });
    unsetenv("BURNISH_PROGRESS_SECONDS");
    close(ends[0]);
    close(ends[1]);
    EXPECT_EQ(text.find('\r'), std::string::npos);
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_GE(lines, 2);
    EXPECT_EQ(text.substr(0, 6), "bake: ");
    EXPECT_NE(text.find(" s left\n"), std::string::npos) << text; // after a second
    EXPECT_EQ(text.back(), '\n');
}

TEST(progress, tells_the_time_that_is_left)
{
    const std::string text = printed_on_terminal([] {
        Progress progress("bake", 10, false);
        for (int i = 0; i < 5; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(260));
            progress.step();
        }
    });
    EXPECT_NE(text.find(" s left"), std::string::npos) << text;
    EXPECT_NE(text.find("bake ["), std::string::npos) << text; // the bar is shorter by this
}

TEST(progress, what_comes_before_the_first_of_many_steps_is_not_counted)
{
    const std::string text = printed_on_terminal([] {
        Progress progress("bake", 100, false);
        std::this_thread::sleep_for(std::chrono::milliseconds(1500));
        for (int i = 0; i < 60; ++i) {
            progress.step();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    });
    EXPECT_EQ(text.find("min left"), std::string::npos) << text;
    EXPECT_EQ(text.find("  1%, "), std::string::npos) << text;
    EXPECT_NE(text.find(" s left"), std::string::npos) << text;
}

TEST(progress, nothing_when_quiet)
{
    EXPECT_EQ(printed_on_terminal([] { work(true); }), "");
}

TEST(progress, one_line_that_is_cleared_at_the_end)
{
    const std::string text = printed_on_terminal([] { work(false); });
    EXPECT_NE(text.find("a label"), std::string::npos);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    ASSERT_GE(text.size(), 42u);
    EXPECT_EQ(text.substr(text.size() - 41), "\r" + std::string(39, ' ') + "\r"); // fits 40 columns
}

TEST(progress, redraws_at_most_ten_times_a_second)
{
    const auto begin = std::chrono::steady_clock::now();
    const std::string text = printed_on_terminal([] {
        Progress progress("bake", 300, false);
        std::vector<std::thread> threads;
        for (int t = 0; t < 3; ++t)
            threads.emplace_back([&] {
                for (int i = 0; i < 100; ++i) {
                    progress.step();
                    std::this_thread::sleep_for(std::chrono::milliseconds(3));
                }
            });
        for (std::thread& thread : threads)
            thread.join();
    });
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::size_t draws = 0;
    for (std::size_t at = text.find("bake"); at != std::string::npos; at = text.find("bake", at + 1))
        ++draws;
    EXPECT_GE(draws, 2u);
    EXPECT_LE(static_cast<double>(draws), seconds.count() * 10.0 + 1.0);
}

TEST(progress, without_steps_prints_nothing)
{
    EXPECT_EQ(printed_on_terminal([] { const Progress progress("idle", 10, false); }), "");
}

} // namespace
} // namespace burnish
