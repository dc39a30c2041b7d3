// Parallel loops over oneTBB: one task arena a Jobs object, so that two objects with different thread counts can live
// side by side.
#include "core/jobs/jobs.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <mutex>

#include "core/jobs/cores.h"

namespace burnish {
namespace {

// Pieces of work a thread: small enough to balance uneven tiles, large enough that handing out costs nothing.
constexpr std::size_t kPiecesPerThread = 64;

// oneTBB starts no more workers than cores unless it is told that it may. The least of all live controls
// counts, so there is one for the process, and it only grows. Leaked on purpose: workers may outlive static
// objects.
void allow_threads(int threads)
{
    static std::mutex mutex;
    static tbb::global_control* control = nullptr;
    static int allowed = tbb::info::default_concurrency();
    const std::lock_guard lock(mutex);
    if (threads <= allowed)
        return;
    delete control;
    allowed = threads;
    control = new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(allowed));
}

} // namespace

struct Jobs::Impl {
    int threads = 1;
    mutable tbb::task_arena arena;
};

Jobs::Jobs(int threads) : impl_(std::make_unique<Impl>())
{
    impl_->threads = std::min(threads <= 0 ? usable_cores() : threads, kMostThreads);
    if (impl_->threads == 1)
        return;
    allow_threads(impl_->threads);
    impl_->arena.initialize(impl_->threads);
}

Jobs::~Jobs() = default;

int Jobs::threads() const
{
    return impl_->threads;
}

void Jobs::parallel_for(std::size_t count, const std::function<void(std::size_t, int)>& body) const
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
    impl_->arena.execute([&] {
        // Isolation: a thread that waits for an inner loop must not begin another index of the outer one, or
        // two bodies would share the scratch memory of one worker.
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
}

} // namespace burnish
