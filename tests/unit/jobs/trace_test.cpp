#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include "core/jobs/jobs.h"

namespace burnish {
namespace {

using nlohmann::json;

// One test covers everything, since the program has a single trace with consecutive steps.
TEST(trace, spans_become_chrome_events)
{
    EXPECT_FALSE(Trace::on());
    {
        const TraceSpan before("before the start");
    }
    EXPECT_EQ(Trace::json().find("before the start"), std::string::npos);

    Trace::start();
    EXPECT_TRUE(Trace::on());
    {
        const TraceSpan outer("outer");
        const TraceSpan quoted("a \"quoted\"\\\n name");
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    constexpr int kThreads = 4, kSpans = 3000; // more than one chunk each
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t)
        threads.emplace_back([] {
            for (int i = 0; i < kSpans; ++i)
                const TraceSpan span("inner");
        });
    const json while_running = json::parse(Trace::json()); // reading beside writers is safe
    EXPECT_TRUE(while_running.contains("traceEvents"));
    for (std::thread& thread : threads)
        thread.join();

    const json trace = json::parse(Trace::json());
    std::map<std::string, int> count;
    std::set<int> inner_threads;
    std::map<int, std::string> thread_names;
    for (const json& event : trace["traceEvents"]) {
        EXPECT_EQ(event["pid"], 1);
        if (event["ph"] == "M") {
            EXPECT_EQ(event["name"], "thread_name");
            thread_names[event["tid"]] = event["args"]["name"];
            continue;
        }
        ASSERT_EQ(event["ph"], "X");
        EXPECT_GE(event["ts"].get<double>(), 0.0);
        ++count[event["name"]];
        if (event["name"] == "inner")
            inner_threads.insert(event["tid"].get<int>());
        if (event["name"] == "outer") {
            EXPECT_GE(event["dur"].get<double>(), 3000.0); // microseconds
            EXPECT_LT(event["dur"].get<double>(), 3e6);
            EXPECT_EQ(event["tid"], 0);
        }
    }
    EXPECT_EQ(count["outer"], 1);
    EXPECT_EQ(count["a \"quoted\"\\\n name"], 1);
    EXPECT_EQ(count["inner"], kThreads * kSpans);
    EXPECT_EQ(inner_threads, (std::set<int>{1, 2, 3, 4}));
    EXPECT_EQ(thread_names[0], "main");
    EXPECT_EQ(thread_names[4], "worker 4");
    EXPECT_EQ(trace["otherData"]["dropped_events"], 0);

    const std::uint64_t now = Trace::now_ns();
    for (int i = 0; i < 1'000'000; ++i)
        Trace::span("filler", now, now + 1);
    const std::string full = Trace::json();
    std::size_t events = 0;
    for (std::size_t at = full.find("\"X\""); at != std::string::npos; at = full.find("\"X\"", at + 1))
        ++events;
    EXPECT_EQ(events, 1'000'000u);
    EXPECT_NE(full.find("\"dropped_events\":" + std::to_string(kThreads * kSpans + 2)), std::string::npos);
}

} // namespace
} // namespace burnish
