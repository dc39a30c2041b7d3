#include "apps/cli/stop_signal.h"

#include <csignal>

namespace burnish {
namespace {

std::atomic<bool> stop{false};
std::atomic<int> came{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void on_stop_signal(int signal)
{
    came.store(signal);
    stop.store(true);
    std::signal(signal, SIG_DFL);
}

} // namespace

const std::atomic<bool>& watch_stop_signals()
{
    std::signal(SIGINT, on_stop_signal);
    std::signal(SIGTERM, on_stop_signal);
    return stop;
}

void stop_at_signals()
{
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

int stop_signal()
{
    return came.load();
}

} // namespace burnish
