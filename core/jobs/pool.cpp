// The process's own threads, for builds without oneTBB and systems that refuse oneTBB threads. Threads start once and
// stay. A loop starts no thread, so it cannot fail for lack of one.
#include "core/jobs/pool.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "core/jobs/threads.h"

#ifdef __SANITIZE_THREAD__
// Embree's trees and OpenImageIO's name table use locks that ThreadSanitizer does not see.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions()
{
    return "race:libembree3.so\nrace:libOpenImageIO\n";
}
#endif

namespace burnish {
namespace {

// Looks for work before an idle thread sleeps: one frame's loops follow each other closely.
constexpr int kLooks = 200;

// The running thread's worker number in one object; a list from the innermost loop outwards.
struct Seated {
    const Seats* seats;
    int worker;
    const Seated* outer;
};

thread_local const Seated* innermost = nullptr;

const Seated* seat_of(const Seats& seats)
{
    const Seated* seated = innermost;
    while (seated && seated->seats != &seats)
        seated = seated->outer;
    return seated;
}

struct Loop {
    const std::function<void(std::size_t, int)>& body;
    std::size_t count, grain;
    Seats& seats;
    std::atomic<std::size_t> next{0};
    std::atomic<int> helpers{0}; // changed under the pool's mutex
    std::exception_ptr thrown{}; // the first exception, guarded by the pool's mutex
};

// The process's threads that help with loops.
struct Pool {
    std::mutex mutex;
    std::condition_variable work, seat, left; // signals: a loop opened, a worker number came back, a loop's last helper left
    std::vector<Loop*> open;
    std::atomic<std::uint64_t> opened{0}; // number of loops so far
    int asleep = 0;
    std::mutex starting;
    int threads = 0; // guarded by `starting`
};

// Leaked on purpose: the threads run until the process ends.
Pool& pool()
{
    static Pool* const p = new Pool;
    return *p;
}

// Runs indices of the loop until none is left.
void run_pieces(Loop& loop, int worker)
{
    const Seated here = {&loop.seats, worker, innermost};
    innermost = &here;
    try {
        // relaxed: handing out indices orders nothing
        for (std::size_t i; (i = loop.next.fetch_add(loop.grain, std::memory_order_relaxed)) < loop.count;)
            for (const std::size_t end = std::min(i + loop.grain, loop.count); i < end; ++i)
                loop.body(i, worker);
    } catch (...) {
        loop.next.store(loop.count, std::memory_order_relaxed);
        const std::lock_guard lock(pool().mutex);
        if (!loop.thrown)
            loop.thrown = std::current_exception();
    }
    innermost = here.outer;
}

// Returns the innermost open loop with work and a free worker number, or null.
Loop* open_loop(const Pool& p)
{
    for (auto loop = p.open.rbegin(); loop != p.open.rend(); ++loop)
        if ((*loop)->next.load(std::memory_order_relaxed) < (*loop)->count && !(*loop)->seats.empty())
            return *loop;
    return nullptr;
}

void wait_for_work(Pool& p, std::unique_lock<std::mutex>& lock)
{
    const std::uint64_t seen = p.opened.load();
    lock.unlock();
    for (int i = 0; i < kLooks && p.opened.load(std::memory_order_relaxed) == seen; ++i)
        std::this_thread::yield();
    lock.lock();
    ++p.asleep;
    p.work.wait(lock, [&] { return p.opened.load() != seen; });
    --p.asleep;
}

void help(Pool& p, std::unique_lock<std::mutex>& lock, Loop& loop)
{
    const int worker = loop.seats.back();
    loop.seats.pop_back();
    ++loop.helpers;
    lock.unlock();
    run_pieces(loop, worker);
    lock.lock();
    loop.seats.push_back(worker); // never allocates: the number came from this list
    p.seat.notify_one();
    if (--loop.helpers == 0)
        p.left.notify_all();
}

// Thread function: helps open loops forever, and sleeps between them.
void serve(void*)
{
    Pool& p = pool();
    std::unique_lock lock(p.mutex);
    for (;;)
        if (Loop* const loop = open_loop(p))
            help(p, lock, *loop);
        else
            wait_for_work(p, lock);
}

// Takes one of the object's worker numbers for the calling thread. Waits while other threads hold them all.
int take_seat(Pool& p, std::unique_lock<std::mutex>& lock, Seats& seats)
{
    p.seat.wait(lock, [&] { return !seats.empty(); });
    const int worker = seats.back();
    seats.pop_back();
    return worker;
}

void run_with_helpers(Loop& loop, int threads)
{
    Pool& p = pool();
    std::unique_lock lock(p.mutex);
    // Take a worker number, and open the loop
    const Seated* const had = seat_of(loop.seats);
    const int worker = had ? had->worker : take_seat(p, lock, loop.seats);
    p.open.push_back(&loop);
    p.opened.fetch_add(1);
    // Wake as many sleeping threads as the loop can use
    const std::size_t wanted = std::min(static_cast<std::size_t>(threads), (loop.count + loop.grain - 1) / loop.grain) - 1;
    for (std::size_t i = std::min(wanted, static_cast<std::size_t>(p.asleep)); i > 0; --i)
        p.work.notify_one();
    // Run pieces on this thread
    lock.unlock();
    run_pieces(loop, worker);
    lock.lock();
    // Close the loop, and wait for its helpers
    p.open.erase(std::find(p.open.begin(), p.open.end(), &loop));
    if (loop.helpers.load() > 0) {
        lock.unlock();
        for (int i = 0; i < kLooks && loop.helpers.load() > 0; ++i)
            std::this_thread::yield();
        lock.lock();
        p.left.wait(lock, [&] { return loop.helpers.load() == 0; });
    }
    // Give back the worker number
    if (!had) {
        loop.seats.push_back(worker);
        p.seat.notify_one();
    }
}

} // namespace

int start_pool(int wanted)
{
    Pool& p = pool();
    const std::lock_guard lock(p.starting);
    while (p.threads < wanted) {
        if (const int code = start_thread(serve, nullptr)) {
            note_missing_threads(p.threads + 1, wanted + 1, code);
            break;
        }
        ++p.threads;
    }
    return std::min(p.threads, wanted);
}

void run_in_pool(Seats& seats, int threads, std::size_t count, std::size_t grain, const std::function<void(std::size_t, int)>& body)
{
    Loop loop{body, count, grain, seats};
    run_with_helpers(loop, threads);
    if (loop.thrown)
        std::rethrow_exception(loop.thrown);
}

} // namespace burnish
