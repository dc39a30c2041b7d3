#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/jobs/activity.h"
#include "core/jobs/control.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

constexpr std::uint64_t kRedrawNs = 100'000'000; // at most ten times a second
constexpr double kTellSeconds = 1.0;             // elapsed before the remaining time is estimated
constexpr double kSmallPart = 0.02;              // share of the work: the estimate ignores the time before such a small first step
constexpr std::size_t kBarCells = 30;

// Returns ", 1:05 min left", or "" while it is too early to tell.
std::string time_left(double part, double elapsed_s)
{
    if (elapsed_s < kTellSeconds || part <= 0.0 || part >= 1.0)
        return "";
    const auto left = static_cast<std::uint64_t>(std::min(elapsed_s / part * (1.0 - part) + 0.5, 1e9));
    return left < 60     ? fmt::format(", {} s left", left)
           : left < 3600 ? fmt::format(", {}:{:02} min left", left / 60, left % 60)
                         : fmt::format(", {}:{:02} h left", left / 3600, left / 60 % 60);
}

std::size_t terminal_columns()
{
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
        return size.ws_col;
    return 80;
}

} // namespace

struct Progress::Impl {
    std::string label;
    std::size_t total = 0;
    bool shown = true, terminal = false;
    std::optional<ControlledWork> control;
    std::uint64_t begin_ns = 0, period_ns = kRedrawNs;
    std::atomic<std::uint64_t> first_ns{0}; // time of the first of many steps, 0 before that step
    std::atomic<std::size_t> first_done{0}; // work of that step, excluded from the estimate
    std::atomic<std::size_t> done{0};
    std::atomic<std::uint64_t> next_draw_ns{0};
    std::mutex drawing;
    std::size_t drawn = 0;            // characters on the line, guarded by `drawing`
    std::optional<Activity> activity; // reports slow steps, too

    double part() const { return part_after(0); }
    double part_after(std::size_t first) const
    {
        const double steps = static_cast<double>(done.load() - first), all = static_cast<double>(total) - static_cast<double>(first);
        return all > 0.0 ? std::min(1.0, steps / all) : 1.0;
    }
    std::string left() const
    {
        const std::uint64_t first = first_ns.load(std::memory_order_relaxed);
        return time_left(part_after(first ? first_done.load() : 0),
                         static_cast<double>(Trace::now_ns() - (first ? first : begin_ns)) * 1e-9);
    }

    void draw()
    {
        Activity::restart_interval();
        if (!terminal) {
            std::fprintf(stderr, "%s: %.0f %%%s\n", label.c_str(), part() * 100.0, left().c_str());
            return;
        }
        const std::size_t room = terminal_columns() - 1; // a wrapped line cannot be redrawn
        const std::string tail = fmt::format("] {:3.0f}%{}", part() * 100.0, left()), head = label + " [";
        const std::size_t words = std::min(room, head.size() + tail.size()), cells = std::min(kBarCells, room - words);
        const std::size_t full = static_cast<std::size_t>(part() * static_cast<double>(cells));
        std::string line = head + std::string(full, '#') + std::string(cells - full, '.') + tail;
        line.resize(std::min(line.size(), room));
        const std::size_t size = line.size();
        if (size < drawn)
            line.append(drawn - size, ' ');
        drawn = size;
        std::fprintf(stderr, "\r%s", line.c_str());
        std::fflush(stderr);
    }
};

Progress::Progress(std::string label, std::size_t total, bool quiet)
{
    impl_ = std::make_unique<Impl>();
    impl_->label = printable(label);
    impl_->total = total;
    impl_->shown = !quiet;
    impl_->control.emplace(ControlledWork::Kind::count, impl_->label, total);
    if (quiet)
        return;
    impl_->terminal = isatty(STDERR_FILENO) != 0;
    impl_->period_ns = impl_->terminal ? kRedrawNs : Activity::interval_ns();
    impl_->begin_ns = Trace::now_ns();
    impl_->next_draw_ns = impl_->begin_ns + (impl_->terminal ? 0 : impl_->period_ns); // short work stays silent
    impl_->activity.emplace(impl_->label, [impl = impl_.get()] {
        const std::lock_guard lock(impl->drawing);
        impl->next_draw_ns = Trace::now_ns() + impl->period_ns;
        impl->draw();
    });
}

Progress::~Progress()
{
    impl_->activity.reset();
    if (impl_->drawn == 0)
        return;
    std::fprintf(stderr, "\r%*s\r", static_cast<int>(impl_->drawn), "");
    std::fflush(stderr);
}

void Progress::step(std::size_t n)
{
    impl_->control->step(n);
    if (!impl_->shown)
        return;
    impl_->done.fetch_add(n, std::memory_order_relaxed);
    const std::uint64_t now = Trace::now_ns();
    std::uint64_t none = 0;
    if (impl_->first_ns.load(std::memory_order_relaxed) == 0 && impl_->part() <= kSmallPart)
        impl_->first_done.store(n), impl_->first_ns.compare_exchange_strong(none, now);
    std::uint64_t due = impl_->next_draw_ns.load(std::memory_order_relaxed);
    if (now < due || !impl_->next_draw_ns.compare_exchange_strong(due, now + impl_->period_ns))
        return; // too early, or another thread draws
    const std::lock_guard lock(impl_->drawing);
    impl_->draw();
}

} // namespace burnish
