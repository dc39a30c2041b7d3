#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <mutex>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

constexpr std::uint64_t kRedrawNs = 100'000'000; // at most ten times a second
constexpr std::size_t kBarCells = 30;

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
    std::atomic<std::size_t> done{0};
    std::atomic<std::uint64_t> next_draw_ns{0};
    std::mutex drawing;
    std::size_t drawn = 0; // characters now on the line, guarded by `drawing`

    void draw()
    {
        const double part = total ? std::min(1.0, static_cast<double>(done.load()) / static_cast<double>(total)) : 1.0;
        const std::size_t full = static_cast<std::size_t>(part * static_cast<double>(kBarCells));
        std::string line =
            fmt::format("{} [{}{}] {:3.0f}%", label, std::string(full, '#'), std::string(kBarCells - full, '.'), part * 100.0);
        line.resize(std::min(line.size(), terminal_columns() - 1)); // a wrapped line could not be redrawn
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
    if (quiet || !isatty(STDERR_FILENO))
        return;
    impl_ = std::make_unique<Impl>();
    impl_->label = printable(label);
    impl_->total = total;
}

Progress::~Progress()
{
    if (!impl_ || impl_->drawn == 0)
        return;
    std::fprintf(stderr, "\r%*s\r", static_cast<int>(impl_->drawn), "");
    std::fflush(stderr);
}

void Progress::step(std::size_t n)
{
    if (!impl_)
        return;
    impl_->done.fetch_add(n, std::memory_order_relaxed);
    const std::uint64_t now = Trace::now_ns();
    std::uint64_t due = impl_->next_draw_ns.load(std::memory_order_relaxed);
    if (now < due || !impl_->next_draw_ns.compare_exchange_strong(due, now + kRedrawNs))
        return; // not yet, or another thread draws
    const std::lock_guard lock(impl_->drawing);
    impl_->draw();
}

} // namespace burnish
