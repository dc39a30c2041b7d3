// A parallel loop of bare threads, for ThreadSanitizer only: oneTBB's library is not built with it, so every hand-over inside oneTBB would
// be reported as a race, and hiding those reports would hide real ones. Here the only order between threads is what std::thread gives:
// before the loop, the bodies in no order, after the loop. An inner loop runs on the thread that meets it.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define BN_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define BN_TSAN 1
#endif
#endif

#ifdef BN_TSAN
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace burnish {

inline void plain_parallel_for(int threads, std::size_t count, const std::function<void(std::size_t, int)>& body)
{
    thread_local int inside = -1; // the worker that runs on this thread
    if (inside >= 0) {
        for (std::size_t i = 0; i < count; ++i)
            body(i, inside < threads ? inside : 0);
        return;
    }
    std::atomic<std::size_t> next{0};
    std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(threads));
    const auto work = [&](int worker) {
        inside = worker;
        try {
            // relaxed: handing out indices orders nothing
            for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;)
                body(i, worker);
        } catch (...) {
            thrown[static_cast<std::size_t>(worker)] = std::current_exception();
        }
        inside = -1;
    };
    std::vector<std::thread> others;
    for (int worker = 1; worker < threads; ++worker)
        others.emplace_back(work, worker);
    work(0);
    for (std::thread& other : others)
        other.join();
    for (const std::exception_ptr& e : thrown)
        if (e)
            std::rethrow_exception(e);
}

} // namespace burnish
#endif
