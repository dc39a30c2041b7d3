#include "core/jobs/activity.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/jobs/control.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

constexpr double kLineSeconds = 10.0;                // between lines without a terminal
constexpr std::uint64_t kTerminalNs = 1'000'000'000; // before a line appears on a terminal, and between redraws
constexpr std::size_t kWatcherStack = 256 << 10;     // bytes: small, so that the watcher starts where address space is short
constexpr std::size_t kMostLine = 79;                // characters on a terminal: a wrapped line cannot be redrawn

struct Entry {
    std::uint64_t id, begin_ns;
    pthread_t thread;
    std::string what;
    std::function<void()> say;
};

// All activities of the process, oldest first, and their watcher thread. Never destroyed, because the watcher outlives
// main().
struct Board {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<Entry> entries;
    std::uint64_t next_id = 1, period_ns = 0;
    bool on = false, watched = false, terminal = false;
    std::size_t drawn = 0; // length of the line on the terminal
    std::atomic<std::uint64_t> said_ns{0};

    void clear_line()
    {
        if (drawn > 0)
            std::fprintf(stderr, "\r%*s\r", static_cast<int>(drawn), "");
        drawn = 0;
    }
    void say(std::uint64_t now)
    {
        said_ns = now;
        const Entry& last = entries.back();
        if (last.say)
            return last.say();
        std::string line;
        for (const Entry& e : entries)
            if (pthread_equal(e.thread, last.thread))
                line += (line.empty() ? "" : ", ") + e.what;
        line += fmt::format(": {} s", (now - last.begin_ns) / 1'000'000'000);
        if (!terminal) {
            std::fprintf(stderr, "%s\n", line.c_str());
            return;
        }
        line.resize(std::min(line.size(), kMostLine));
        const std::size_t size = line.size();
        line.resize(std::max(size, drawn), ' ');
        drawn = size;
        std::fprintf(stderr, "\r%s", line.c_str());
    }
};

Board& board()
{
    static Board* const made = new Board;
    return *made;
}

void* watch(void*)
{
    Board& b = board();
    std::unique_lock lock(b.mutex);
    for (;;) {
        const std::uint64_t now = Trace::now_ns(), due = b.said_ns + b.period_ns;
        if (!b.on || b.entries.empty())
            b.changed.wait(lock);
        else if (now < due)
            b.changed.wait_for(lock, std::chrono::nanoseconds(due - now));
        else
            try {
                b.say(now);
            } catch (...) { // no memory: skip the line
            }
    }
    return nullptr;
}

// Starts the watcher thread. If the system refuses the thread, no lines appear.
void start_watcher(Board& b)
{
    b.watched = true;
    b.terminal = isatty(STDERR_FILENO) != 0;
    b.period_ns = b.terminal ? kTerminalNs : Activity::interval_ns();
    b.said_ns = Trace::now_ns();
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0)
        return;
    pthread_t thread;
    pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
    pthread_attr_setstacksize(&attributes, kWatcherStack);
    static_cast<void>(pthread_create(&thread, &attributes, watch, nullptr));
    pthread_attr_destroy(&attributes);
}

} // namespace

Activity::Activity(std::string what) : Activity(std::move(what), nullptr) {}

Activity::Activity(std::string what, std::function<void()> say)
{
    report_activity(what);
    Board& b = board();
    const std::lock_guard lock(b.mutex);
    id_ = b.next_id++;
    b.entries.push_back({id_, Trace::now_ns(), pthread_self(), printable(what), std::move(say)});
    if (b.on && !b.watched)
        start_watcher(b);
    b.changed.notify_one();
}

Activity::~Activity()
{
    Board& b = board();
    const std::lock_guard lock(b.mutex);
    std::erase_if(b.entries, [this](const Entry& e) { return e.id == id_; });
    b.clear_line();
}

void Activity::tell(bool on)
{
    Board& b = board();
    const std::lock_guard lock(b.mutex);
    b.on = on;
    if (on && !b.watched && !b.entries.empty())
        start_watcher(b);
    b.changed.notify_one();
}

void Activity::restart_interval()
{
    board().said_ns = Trace::now_ns();
}

std::string Activity::innermost()
{
    Board& b = board();
    const std::lock_guard lock(b.mutex);
    const auto mine =
        std::find_if(b.entries.rbegin(), b.entries.rend(), [](const Entry& e) { return pthread_equal(e.thread, pthread_self()) != 0; });
    return mine == b.entries.rend() ? "" : mine->what;
}

std::uint64_t Activity::interval_ns()
{
    const char* text = std::getenv("BURNISH_PROGRESS_SECONDS");
    const double seconds = text ? std::strtod(text, nullptr) : kLineSeconds;
    return static_cast<std::uint64_t>((seconds > 0.0 && seconds < 1e6 ? seconds : kLineSeconds) * 1e9);
}

} // namespace burnish
