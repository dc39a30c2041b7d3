#include "core/jobs/threads.h"

#include <pthread.h>

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <vector>

#include <fmt/format.h>

namespace burnish {
namespace {

constexpr std::size_t kStackBytes = 4u << 20; // lane loops need little stack, and address space may be short

struct Start {
    void (*run)(void*);
    void* argument;
};

void* run_start(void* start)
{
    const Start own = *static_cast<Start*>(start);
    delete static_cast<Start*>(start);
    own.run(own.argument);
    return nullptr;
}

// Holds threads until all available threads have started.
struct Gate {
    std::mutex mutex;
    std::condition_variable opened;
    bool open = false;
};

void* wait_at(void* at)
{
    Gate& gate = *static_cast<Gate*>(at);
    std::unique_lock lock(gate.mutex);
    gate.opened.wait(lock, [&] { return gate.open; });
    return nullptr;
}

struct Missing {
    std::mutex mutex;
    int given = 0, wanted = 0, code = 0;
};

// Leaked on purpose: threads may still run while static objects are destroyed.
Missing& missing()
{
    static Missing* const m = new Missing;
    return *m;
}

} // namespace

int start_thread(void (*run)(void*), void* argument)
{
    pthread_attr_t how;
    if (const int code = ::pthread_attr_init(&how))
        return code;
    ::pthread_attr_setstacksize(&how, kStackBytes);
    ::pthread_attr_setdetachstate(&how, PTHREAD_CREATE_DETACHED);
    auto* const start = new Start{run, argument};
    pthread_t thread;
    const int code = ::pthread_create(&thread, &how, run_start, start);
    ::pthread_attr_destroy(&how);
    if (code)
        delete start;
    return code;
}

GivenThreads given_threads(int count)
{
    Gate gate;
    std::vector<pthread_t> threads(static_cast<std::size_t>(count));
    int given = 0, code = 0;
    while (given < count && code == 0) {
        code = ::pthread_create(&threads[static_cast<std::size_t>(given)], nullptr, wait_at, &gate);
        given += code == 0;
    }
    {
        const std::lock_guard lock(gate.mutex);
        gate.open = true;
    }
    gate.opened.notify_all();
    for (int i = 0; i < given; ++i)
        ::pthread_join(threads[static_cast<std::size_t>(i)], nullptr);
    return {given, code};
}

Status expect_threads(int count, const std::string& who)
{
    const auto [given, code] = given_threads(count);
    if (code == 0)
        return {};
    return Error{ExitCode::bad_input, "", "",
                 fmt::format("{} starts {} threads, and the system gives {} ({})", who, count, given, std::strerror(code))};
}

void note_missing_threads(int given, int wanted, int code)
{
    Missing& m = missing();
    const std::lock_guard lock(m.mutex);
    if (wanted - given > m.wanted - m.given)
        m.given = given, m.wanted = wanted, m.code = code;
}

std::string missing_threads()
{
    Missing& m = missing();
    const std::lock_guard lock(m.mutex);
    if (m.wanted == m.given)
        return "";
    return fmt::format("the system gives {} of {} threads ({}): the work went on with those", m.given, m.wanted, std::strerror(m.code));
}

} // namespace burnish
