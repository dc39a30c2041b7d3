#include "core/jobs/cores.h"

#ifndef __EMSCRIPTEN__
#include <sched.h>
#endif

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

#include "core/base/cgroup.h"

namespace burnish {
namespace {

int affinity_cores()
{
#ifdef __EMSCRIPTEN__ // compiled without threads
    return 1;
#else
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof(set), &set) == 0 && CPU_COUNT(&set) > 0)
        return CPU_COUNT(&set);
    // The machine has more cores than cpu_set_t holds.
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
#endif
}

// Returns the cores that a cgroup v2 folder's cpu.max grants ("max 100000" or "150000 100000"), or `unlimited`.
int quota_cores(const std::string& folder, int unlimited)
{
    std::ifstream file(folder + "/cpu.max");
    std::string quota;
    long long period = 0;
    if (!(file >> quota >> period) || quota == "max" || period <= 0)
        return unlimited;
    const long long granted = std::strtoll(quota.c_str(), nullptr, 10);
    if (granted <= 0)
        return unlimited;
    return static_cast<int>(std::clamp<long long>((granted + period - 1) / period, 1, unlimited));
}

// Returns the tightest quota from the process's own cgroup v2 folder up to the root.
int cgroup_cores(int unlimited)
{
    int cores = unlimited;
    for (const std::string& folder : cgroup_folders("cpu"))
        cores = std::min(cores, quota_cores(folder, unlimited));
    return cores;
}

} // namespace

int usable_cores()
{
    const int cores = affinity_cores();
    return std::min(cores, cgroup_cores(cores));
}

} // namespace burnish
