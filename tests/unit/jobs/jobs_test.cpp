#include "core/jobs/jobs.h"

#include <gtest/gtest.h>

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "core/jobs/cores.h"
#include "core/jobs/threads.h"

namespace burnish {
namespace {

// A time limit for waiting on threads. Threads may start late on busy cores, and a test must still end.
class Patience {
  public:
    bool lasts() const { return std::chrono::steady_clock::now() < end_; }

  private:
    std::chrono::steady_clock::time_point end_ = std::chrono::steady_clock::now() + std::chrono::seconds(30);
};

TEST(jobs, every_index_runs_once)
{
    for (const int threads : {1, 2, 3, 8}) {
        const Jobs jobs(threads);
        for (const std::size_t count : {0u, 1u, 2u, 7u, 1000u, 100003u}) {
            std::vector<std::atomic<int>> runs(count);
            jobs.parallel_for(count, [&](std::size_t i, int) { ++runs[i]; });
            EXPECT_TRUE(std::all_of(runs.begin(), runs.end(), [](const auto& n) { return n == 1; })) << threads;
        }
    }
}

TEST(jobs, one_thread_runs_in_order_on_the_caller)
{
    std::vector<std::size_t> order;
    Jobs(1).parallel_for(5, [&, caller = std::this_thread::get_id()](std::size_t i, int worker) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(worker, 0);
        order.push_back(i);
    });
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

// Each index waits until the requested number of threads is inside, even more threads than cores.
TEST(jobs, uses_exactly_the_threads_asked_for)
{
    for (const int threads : {2, 5}) {
        const Jobs jobs(threads);
        ASSERT_EQ(jobs.threads(), threads);
        std::atomic<int> inside{0}, most{0};
        const Patience patience;
        jobs.parallel_for(200, [&](std::size_t, int) {
            const int now = ++inside;
            int seen = most;
            while (now > seen && !most.compare_exchange_weak(seen, now)) {
            }
            while (most < threads && patience.lasts())
                std::this_thread::yield();
            --inside;
        });
        EXPECT_EQ(most, threads);
    }
}

TEST(jobs, a_worker_is_one_thread_at_a_time)
{
    const Jobs jobs(4);
    std::vector<std::atomic<int>> busy(4);
    std::atomic<int> clashes{0};
    jobs.parallel_for(2000, [&](std::size_t, int worker) {
        ASSERT_GE(worker, 0);
        ASSERT_LT(worker, 4);
        if (busy[static_cast<std::size_t>(worker)].fetch_add(1) != 0)
            ++clashes;
        std::this_thread::yield();
        --busy[static_cast<std::size_t>(worker)];
    });
    EXPECT_EQ(clashes, 0);
}

// While an inner loop waits, its thread must not begin another outer index with the same scratch memory.
TEST(jobs, nested_loops_do_not_share_scratch)
{
    const Jobs jobs(4);
    std::vector<std::atomic<int>> outer(4);
    std::atomic<int> clashes{0}, runs{0};
    // Short uneven loops: near the end of each, some threads wait for inner pieces while outer pieces remain.
    for (int repeat = 0; repeat < 100; ++repeat)
        jobs.parallel_for(5, [&](std::size_t index, int worker) {
            if (outer[static_cast<std::size_t>(worker)].fetch_add(1) != 0)
                ++clashes;
            std::this_thread::sleep_for(std::chrono::microseconds(index % 2 ? 500 : 0));
            jobs.parallel_for(2, [&](std::size_t i, int) {
                std::this_thread::sleep_for(std::chrono::microseconds(i ? 500 : 20));
                ++runs;
            });
            --outer[static_cast<std::size_t>(worker)];
        });
    EXPECT_EQ(clashes, 0);
    EXPECT_EQ(runs, 100 * 5 * 2);
}

TEST(jobs, an_exception_reaches_the_caller)
{
    for (const int threads : {1, 3}) {
        const Jobs jobs(threads);
        const auto throwing = [](std::size_t i, int) {
            if (i == 77)
                throw std::runtime_error("index 77");
        };
        try {
            jobs.parallel_for(1000, throwing);
            FAIL() << "nothing was thrown";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "index 77");
        }
        std::atomic<int> runs{0};
        jobs.parallel_for(10, [&](std::size_t, int) { ++runs; }); // the object still works
        EXPECT_EQ(runs, 10);
    }
}

// As many indices as threads. Each index waits until all workers are inside, so the highest worker is the last one.
TEST(jobs, objects_of_different_size_live_side_by_side)
{
    const Jobs two(2), three(3), six(6);
    for (const Jobs* jobs : {&two, &three, &six, &two}) {
        std::atomic<int> highest{0}, inside{0};
        const Patience patience;
        jobs->parallel_for(static_cast<std::size_t>(jobs->threads()), [&](std::size_t, int worker) {
            int seen = highest;
            while (worker > seen && !highest.compare_exchange_weak(seen, worker)) {
            }
            ++inside;
            while (inside < jobs->threads() && patience.lasts())
                std::this_thread::yield();
        });
        EXPECT_EQ(highest, jobs->threads() - 1);
    }
}

TEST(jobs, objects_of_one_size_after_another_run_on_the_threads_they_name)
{
    const auto total = [](int threads) { // of the numbers below a hundred
        const Jobs jobs(threads);
        EXPECT_EQ(jobs.threads(), threads);
        std::atomic<int> sum = 0;
        jobs.parallel_for(100, [&](std::size_t i, int worker) {
            EXPECT_LT(worker, threads);
            sum += static_cast<int>(i);
        });
        return sum.load();
    };
    for (int round = 0; round < 3; ++round)
        for (const int threads : {2, 3, 2, 1, 4, 3})
            EXPECT_EQ(total(threads), 4950);
    std::vector<std::thread> callers;
    for (int i = 0; i < 4; ++i)
        callers.emplace_back([&, i] {
            for (int round = 0; round < 20; ++round)
                EXPECT_EQ(total(2 + (i + round) % 2), 4950);
        });
    for (std::thread& caller : callers)
        caller.join();
}

// Callers from several threads share an object's worker numbers, and nested loops use another object's.
TEST(jobs, callers_from_other_threads_share_an_object)
{
    const Jobs two(2), three(3);
    std::vector<std::atomic<int>> busy(2);
    std::atomic<int> clashes{0}, runs{0};
    std::vector<std::thread> callers;
    for (int c = 0; c < 4; ++c)
        callers.emplace_back([&] {
            for (int repeat = 0; repeat < 50; ++repeat)
                two.parallel_for(20, [&](std::size_t, int worker) {
                    clashes += busy[static_cast<std::size_t>(worker)].fetch_add(1) != 0;
                    three.parallel_for(3, [&](std::size_t, int other) {
                        EXPECT_LT(other, 3);
                        ++runs;
                    });
                    --busy[static_cast<std::size_t>(worker)];
                });
        });
    for (std::thread& caller : callers)
        caller.join();
    EXPECT_EQ(clashes, 0);
    EXPECT_EQ(runs, 4 * 50 * 20 * 3);
}

TEST(threads, that_are_there_are_expected)
{
    EXPECT_TRUE(expect_threads(0, "nobody"));
    EXPECT_TRUE(expect_threads(3, "a library"));
    EXPECT_EQ(missing_threads(), "");
}

// Little address space makes the system refuse threads, since each thread reserves a stack.
TEST(threads, that_are_not_there_are_an_error)
{
    const auto lack = [] {
        const rlimit little = {256u << 20, 256u << 20};
        if (setrlimit(RLIMIT_AS, &little) != 0)
            std::_Exit(2);
        const Status had = expect_threads(1000, "a library");
        const Jobs many(1000);
        std::atomic<int> runs{0};
        many.parallel_for(5000, [&](std::size_t, int) { ++runs; });
        const bool said =
            !had && had.error().code == ExitCode::bad_input && had.error().reason.starts_with("a library starts 1000 threads");
        std::_Exit(said && many.threads() < 1000 && runs == 5000 && missing_threads().find(" of 1000 threads") != std::string::npos ? 0
                                                                                                                                    : 1);
    };
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "shadow memory reserves terabytes of addresses";
#endif
    EXPECT_EXIT(lack(), testing::ExitedWithCode(0), "");
}

TEST(jobs, zero_threads_means_the_usable_cores)
{
    EXPECT_EQ(Jobs(0).threads(), usable_cores());
    EXPECT_EQ(Jobs().threads(), usable_cores());
    EXPECT_GE(usable_cores(), 1);
}

TEST(jobs, affinity_bounds_the_usable_cores)
{
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
        if (CPU_ISSET(cpu, &before))
            CPU_SET(cpu, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
    EXPECT_EQ(usable_cores(), 1);
    EXPECT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
}

} // namespace
} // namespace burnish
