// Work whose progress the calling thread hears of while another thread works.
#pragma once
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "core/jobs/control.h"

namespace burnish {

// The last report of work in another thread.
struct Reported {
    std::mutex mutex{};
    std::condition_variable ended_now{};
    bool ended = false;
    std::string work{};
    double done = -1.0;
};

#ifdef __EMSCRIPTEN__ // compiled without threads: the work itself tells
template <class Work> auto run_told(const std::function<int(const char* work, double done)>& tell, const Work& work) -> decltype(work())
{
    if (!tell)
        return work();
    std::stop_source stop;
    auto told = std::chrono::steady_clock::now();
    const Controlled controlled({stop.get_token(), [&](const std::string& name, double done) {
                                     const auto now = std::chrono::steady_clock::now();
                                     if (now - told < std::chrono::milliseconds(100))
                                         return;
                                     told = now;
                                     if (tell(name.c_str(), done) != 0)
                                         stop.request_stop();
                                 }});
    return work();
}
#else
// Returns the result of work(), which runs in a thread of its own while the calling thread calls `tell` ten times a second. A result of
// `tell` other than 0 stops the work. Without `tell`, the calling thread works.
template <class Work> auto run_told(const std::function<int(const char* work, double done)>& tell, const Work& work) -> decltype(work())
{
    if (!tell)
        return work();
    Reported reported;
    std::stop_source stop;
    std::optional<decltype(work())> result;
    std::exception_ptr thrown, thrown_by_caller;
    std::thread worker([&] {
        try {
            const Controlled controlled({stop.get_token(), [&](const std::string& name, double done) {
                                             const std::lock_guard lock(reported.mutex);
                                             reported.work = name, reported.done = done;
                                         }});
            result = work();
        } catch (...) {
            thrown = std::current_exception();
        }
        const std::lock_guard lock(reported.mutex);
        reported.ended = true;
        reported.ended_now.notify_one();
    });
    std::unique_lock lock(reported.mutex);
    while (!reported.ended_now.wait_for(lock, std::chrono::milliseconds(100), [&] { return reported.ended; })) {
        const std::string name = reported.work;
        const double done = reported.done;
        lock.unlock();
        try {
            if (!stop.stop_requested() && tell(name.c_str(), done) != 0)
                stop.request_stop();
        } catch (...) { // a caller in C++
            thrown_by_caller = std::current_exception();
            stop.request_stop();
        }
        lock.lock();
    }
    lock.unlock();
    worker.join();
    for (const std::exception_ptr& by : {thrown_by_caller, thrown})
        if (by)
            std::rethrow_exception(by);
    return std::move(*result);
}
#endif

} // namespace burnish
