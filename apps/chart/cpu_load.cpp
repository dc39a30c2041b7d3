#include "apps/chart/cpu_load.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include "core/base/clock.h"

namespace burnish {
namespace {

std::optional<std::pair<double, double>> ticks_now()
{
    std::ifstream file("/proc/stat");
    std::string line;
    std::getline(file, line);
    return ticks_of(line);
}

} // namespace

std::optional<std::pair<double, double>> ticks_of(const std::string& proc_stat)
{
    std::istringstream words(proc_stat);
    std::string name;
    words >> name;
    double all = 0.0, idle = 0.0, ticks = 0.0;
    int count = 0;
    // Fields: user nice system idle iowait irq softirq steal. User time includes guest time.
    for (; count < 8 && words >> ticks; ++count) {
        all += ticks;
        idle += count == 3 || count == 4 ? ticks : 0.0;
    }
    if (name != "cpu" || count < 5)
        return std::nullopt;
    return std::pair{all - idle, all};
}

void CpuLoadMeter::begin()
{
    from_ = ticks_now();
    own_from_ms_ = process_cpu_ms();
}

void CpuLoadMeter::end()
{
    const std::optional<std::pair<double, double>> now = ticks_now();
    if (!from_ || !now)
        return;
    const double per_s = static_cast<double>(::sysconf(_SC_CLK_TCK));
    busy_s_ += (now->first - from_->first) / per_s, all_s_ += (now->second - from_->second) / per_s;
    own_s_ += (process_cpu_ms() - own_from_ms_) * 1e-3;
}

std::optional<double> CpuLoadMeter::others() const
{
    constexpr double kLeast = 0.2; // core seconds: ticks are coarse
    if (all_s_ < kLeast)
        return std::nullopt;
    return std::clamp((busy_s_ - own_s_) / all_s_, 0.0, 1.0);
}

} // namespace burnish
