#include "core/jobs/control.h"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <utility>

#include "core/jobs/activity.h"
#include "core/jobs/jobs.h"

namespace burnish {

struct ControlState {
    Control control;
    std::atomic<int> counts{0}; // live ControlledWork objects of kind count
    std::atomic<std::uint64_t> next_ns{0};
    std::mutex reporting{};
};

namespace {

constexpr std::uint64_t kReportNs = 100'000'000; // at most ten times a second

// The control of the running thread, and whether the thread runs an index of a controlled loop.
thread_local ControlState* state_here = nullptr;
thread_local bool in_loop_here = false;

void report(ControlState& state, const std::string& name, double done)
{
    if (!state.control.progress)
        return;
    const std::uint64_t now = Trace::now_ns();
    std::uint64_t due = state.next_ns.load(std::memory_order_relaxed);
    if (now < due || !state.next_ns.compare_exchange_strong(due, now + kReportNs))
        return; // too early, or another thread reports
    const std::unique_lock lock(state.reporting, std::try_to_lock);
    if (!lock)
        return;
    const Controlled none(Control{}); // work of the function itself is not controlled
    state.control.progress(name, done);
}

} // namespace

Controlled::Controlled(Control control)
    : state_(new ControlState{std::move(control)}), outer_(std::exchange(state_here, state_.get())),
      outer_in_loop_(std::exchange(in_loop_here, false))
{
}

Controlled::~Controlled()
{
    state_here = outer_, in_loop_here = outer_in_loop_;
}

void check_stop()
{
    if (state_here && state_here->control.stop.stop_requested())
        throw Stopped();
}

std::stop_token stop_here()
{
    return state_here ? state_here->control.stop : std::stop_token();
}

void report_activity(const std::string& name)
{
    check_stop();
    if (state_here && !in_loop_here && state_here->counts.load(std::memory_order_relaxed) == 0)
        report(*state_here, name, -1.0);
}

ControlledWork::ControlledWork(Kind kind, std::string name, std::size_t total) : state_(state_here), kind_(kind), total_(total)
{
    if (!state_)
        return;
    reports_ = state_->control.progress && (kind == Kind::count || (!in_loop_here && state_->counts.load(std::memory_order_relaxed) == 0));
    if (reports_)
        name_ = name.empty() ? Activity::innermost() : std::move(name);
    if (kind == Kind::count)
        ++state_->counts;
}

ControlledWork::~ControlledWork()
{
    if (state_ && kind_ == Kind::count)
        --state_->counts;
}

void ControlledWork::run(const std::function<void(std::size_t, int)>& body, std::size_t index, int worker)
{
    struct Here { // the worker's own state comes back after the index, also by an exception
        ControlState* const outer;
        const bool outer_in_loop = std::exchange(in_loop_here, true);
        explicit Here(ControlState* state) : outer(std::exchange(state_here, state)) {}
        ~Here() { state_here = outer, in_loop_here = outer_in_loop; }
    } const here(state_);
    check_stop();
    body(index, worker);
    step(1);
}

void ControlledWork::step(std::size_t n)
{
    if (!reports_)
        return;
    const std::size_t done = done_.fetch_add(n, std::memory_order_relaxed) + n;
    report(*state_, name_, std::min(1.0, static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total_))));
}

} // namespace burnish
