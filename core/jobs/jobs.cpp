// Parallel loops over oneTBB. Each Jobs object has a task arena, so that objects with different thread counts can
// coexist. oneTBB ends the process where the system refuses a thread. So Jobs asks the system first, and uses burnish's
// own pool where the system gives fewer threads.
#include "core/jobs/jobs.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#ifdef BN_ONETBB
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#endif

#include "core/jobs/control.h"
#include "core/jobs/cores.h"
#include "core/jobs/pool.h"
#include "core/jobs/threads.h"

namespace burnish {
namespace {

// Pieces of work for each thread: small enough to balance uneven tiles, large enough to make scheduling free.
constexpr std::size_t kPiecesPerThread = 64;

#ifdef BN_ONETBB
// Raises oneTBB's limit on workers, which is the core count by default. The smallest live control counts, so the
// process keeps one control, which only grows. Leaked on purpose: workers may outlive static objects.
void allow_threads(int threads)
{
    static tbb::global_control* control = nullptr;
    static int allowed = tbb::info::default_concurrency();
    if (threads <= allowed)
        return;
    delete control;
    allowed = threads;
    control = new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(allowed));
}

// Runs a loop whose bodies wait for each other. This makes oneTBB start its workers while the requested threads are
// surely free.
void start_workers(tbb::task_arena& arena, int threads)
{
    constexpr std::chrono::milliseconds kPatience(20); // a busy machine starts workers late
    std::atomic<int> here = 0;
    const auto begin = std::chrono::steady_clock::now();
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<int>(0, threads, 1),
            [&](const tbb::blocked_range<int>&) {
                for (++here; here < threads && std::chrono::steady_clock::now() - begin < kPatience;)
                    std::this_thread::yield();
            },
            tbb::simple_partitioner());
    });
}

// Arenas that no Jobs object uses, for later ones: oneTBB keeps some memory of each arena that ends. Leaked on purpose, as above.
struct SpareArenas {
    std::mutex mutex;
    std::vector<std::pair<int, std::unique_ptr<tbb::task_arena>>> arenas; // by thread count
    std::size_t made = 0;                                                 // arenas so far; `arenas` has room for all
};
SpareArenas& spare_arenas()
{
    static SpareArenas* spare = new SpareArenas;
    return *spare;
}

std::unique_ptr<tbb::task_arena> take_spare_arena(int threads)
{
    SpareArenas& spare = spare_arenas();
    const std::lock_guard lock(spare.mutex);
    for (auto at = spare.arenas.begin(); at != spare.arenas.end(); ++at)
        if (at->first == threads) {
            std::unique_ptr<tbb::task_arena> arena = std::move(at->second);
            spare.arenas.erase(at);
            return arena;
        }
    return nullptr;
}

// Counts a new arena, so that keep_arena() finds room.
void count_arena()
{
    SpareArenas& spare = spare_arenas();
    const std::lock_guard lock(spare.mutex);
    spare.arenas.reserve(++spare.made);
}

void keep_arena(int threads, std::unique_ptr<tbb::task_arena> arena)
{
    SpareArenas& spare = spare_arenas();
    const std::lock_guard lock(spare.mutex);
    spare.arenas.emplace_back(threads, std::move(arena));
}

// Opens an arena for `threads` threads. Returns null where the system refuses oneTBB a thread now, or has done so
// before.
std::unique_ptr<tbb::task_arena> open_arena(int threads)
{
    static std::mutex mutex;
    static int given = 1;
    static bool refused = false;
    const std::lock_guard lock(mutex);
    if (refused)
        return nullptr;
    const bool grows = threads > given;
    if (grows && given_threads(threads - given).count < threads - given) {
        refused = true;
        return nullptr;
    }
    given = std::max(given, threads);
    allow_threads(threads);
    auto arena = std::make_unique<tbb::task_arena>(threads);
    if (grows)
        start_workers(*arena, threads);
    return arena;
}
#endif

} // namespace

struct Jobs::Impl {
    int threads = 1;
    mutable Seats seats; // for the pool
#ifdef BN_ONETBB
    std::unique_ptr<tbb::task_arena> arena;
#endif
};

Jobs::Jobs(int threads) : impl_(std::make_unique<Impl>())
{
    const int wanted = std::min(threads <= 0 ? usable_cores() : threads, kMostThreads);
    if (wanted == 1)
        return;
#ifdef BN_ONETBB
    impl_->arena = take_spare_arena(wanted);
    if (!impl_->arena && (impl_->arena = open_arena(wanted)))
        count_arena();
    if (impl_->arena) {
        impl_->threads = wanted;
        return;
    }
#endif
    impl_->threads = 1 + start_pool(wanted - 1);
    for (int worker = impl_->threads; worker-- > 0;)
        impl_->seats.push_back(worker);
}

Jobs::~Jobs()
{
#ifdef BN_ONETBB
    if (impl_ && impl_->arena)
        keep_arena(impl_->threads, std::move(impl_->arena));
#endif
}

int Jobs::threads() const
{
    return impl_->threads;
}

bool Jobs::by_onetbb() const
{
#ifdef BN_ONETBB
    return impl_->arena != nullptr;
#else
    return false;
#endif
}

void Jobs::parallel_for(std::size_t count, const std::function<void(std::size_t, int)>& body) const
{
    ControlledWork work(ControlledWork::Kind::loop, "", count);
    if (!work.on())
        return parallel_for_whole(count, body);
    parallel_for_whole(count, [&](std::size_t index, int worker) { work.run(body, index, worker); });
    check_stop(); // an exception in an outer loop may have cut this one short
}

void Jobs::parallel_for_whole(std::size_t count, const std::function<void(std::size_t, int)>& body) const
{
    if (impl_->threads == 1) {
        for (std::size_t i = 0; i < count; ++i)
            body(i, 0);
        return;
    }
    if (count == 0)
        return;
    const std::size_t pieces = static_cast<std::size_t>(impl_->threads) * kPiecesPerThread;
    const std::size_t grain = std::max<std::size_t>(1, count / pieces);
#ifdef BN_ONETBB
    if (impl_->arena) {
        impl_->arena->execute([&] {
            // Isolate: a thread that waits for an inner loop must not begin another index of the outer loop. Otherwise
            // two bodies would share one worker's scratch memory.
            tbb::this_task_arena::isolate([&] {
                tbb::parallel_for(
                    tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                        const int worker = tbb::this_task_arena::current_thread_index();
                        for (std::size_t i = range.begin(); i != range.end(); ++i)
                            body(i, worker);
                    },
                    tbb::simple_partitioner());
            });
        });
        return;
    }
#endif
    run_in_pool(impl_->seats, impl_->threads, count, grain, body);
}

} // namespace burnish
