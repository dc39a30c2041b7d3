#include "bench/scenes/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

#include "core/base/version.h"
#include "core/jobs/cores.h"
#include "core/simd/cpu.h"

namespace burnish {
namespace {

double quantile(const std::vector<double>& sorted, double q)
{
    const double at = q * static_cast<double>(sorted.size() - 1);
    const auto i = static_cast<std::size_t>(at);
    const std::size_t next = std::min(i + 1, sorted.size() - 1);
    return sorted[i] + (sorted[next] - sorted[i]) * (at - static_cast<double>(i));
}

} // namespace

Spread spread_of(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

double load_average()
{
    double load = -1.0;
    return getloadavg(&load, 1) == 1 ? load : -1.0;
}

std::uint64_t resident_bytes()
{
    std::uint64_t all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_resident_bytes()
{
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:") {
            std::uint64_t kib = 0;
            status >> kib;
            return kib * 1024;
        }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

bool reset_peak_memory()
{
    std::ofstream file("/proc/self/clear_refs"); // 5 resets the peak to the present size
    file << "5" << std::flush;
    return file.good();
}

bool Quiet::headline() const
{
    return waited < 0.03 && load < 0.3 * usable_cores();
}

Quiet how_quiet()
{
    constexpr int kRounds = 20;
    constexpr std::uint64_t kAdditions = 10'000'000; // a cycle each, because each addition waits for the previous one
    double least_ms = 1e300, cpu = 0.0;
    const double begin = wall_ms();
    for (int round = 0; round < kRounds; ++round) {
        const double before = process_cpu_ms();
        std::uint64_t sum = 0;
        for (std::uint64_t i = 0; i < kAdditions; ++i) {
            sum += i;
            __asm__ volatile("" : "+r"(sum)); // forces one addition after another
        }
        const double taken = process_cpu_ms() - before;
        least_ms = std::min(least_ms, taken), cpu += taken;
    }
    const double wall = wall_ms() - begin;
    return {static_cast<double>(kAdditions) / (least_ms * 1e6), std::max(0.0, 1.0 - cpu / wall), load_average()};
}

nlohmann::ordered_json machine_json()
{
    return {{"processor", cpu_name()},       {"cores", usable_cores()},           {"version", version()},
            {"compiler", BN_BENCH_COMPILER}, {"build_type", BN_BENCH_BUILD_TYPE}, {"load_average", load_average()}};
}

} // namespace burnish
