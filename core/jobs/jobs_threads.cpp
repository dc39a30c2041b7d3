// Parallel loops of bare threads, in place of jobs.cpp where there is no oneTBB, and for ThreadSanitizer: oneTBB's library is not built
// with it, so every hand-over inside oneTBB would be reported as a race, and hiding those reports would hide real ones. Here the only order
// between threads is what std::thread gives: before the loop, the bodies in no order, after the loop.
#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#include "core/jobs/cores.h"
#include "core/jobs/jobs.h"

// Libraries that are not instrumented either: how threads wait for each other inside them is not seen. Embree builds its trees with threads
// of its own, OpenImageIO's table of names has its own lock. Only ThreadSanitizer asks.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions()
{
    return "race:libembree3.so\nrace:libOpenImageIO\n";
}

namespace burnish {

struct Jobs::Impl {
    int threads = 1;
};

Jobs::Jobs(int threads) : impl_(std::make_unique<Impl>())
{
    impl_->threads = std::min(threads <= 0 ? usable_cores() : threads, kMostThreads);
}

Jobs::~Jobs() = default;

int Jobs::threads() const
{
    return impl_->threads;
}

// An inner loop runs on the thread that meets it.
void Jobs::parallel_for(std::size_t count, const std::function<void(std::size_t, int)>& body) const
{
    thread_local int inside = -1; // the worker that runs on this thread
    const int threads = static_cast<int>(std::min(static_cast<std::size_t>(impl_->threads), count));
    if (threads <= 1 || inside >= 0) {
        for (std::size_t i = 0; i < count; ++i)
            body(i, inside >= 0 && inside < impl_->threads ? inside : 0);
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
