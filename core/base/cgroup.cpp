#include "core/base/cgroup.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <mutex>
#include <sstream>

namespace burnish {
namespace {

// Adds the folders of a group and its ancestors, up to the root of the file system mounted at `mount`.
void add_folders(const std::string& mount, std::string path, std::vector<std::string>& folders)
{
    while (path.size() > 1) {
        folders.push_back(mount + path);
        path.erase(path.find_last_of('/'));
    }
    folders.push_back(mount);
}

std::mutex bound_mutex;
rlim_t found_limit = 0, own_limit = 0; // under bound_mutex; own_limit 0: none was set
int unbound = 0;                       // objects of UnboundMemory, under bound_mutex

void set_data_limit(rlim_t limit)
{
    struct rlimit now {};
    if (::getrlimit(RLIMIT_DATA, &now) != 0)
        return;
    now.rlim_cur = limit;
    static_cast<void>(::setrlimit(RLIMIT_DATA, &now));
}

} // namespace

std::vector<std::string> cgroup_folders(const std::string& controller, const std::string& proc, const std::string& sys)
{
    std::vector<std::string> folders;
    std::ifstream file(proc);
    for (std::string line; std::getline(file, line);) { // version 1: "4:cpu,memory:/PATH"; version 2: "0::/PATH"
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos)
            continue;
        const std::string path = line.substr(second + 1);
        std::istringstream names(line.substr(first + 1, second - first - 1));
        if (second == first + 1)
            add_folders(sys, path, folders);
        for (std::string name; std::getline(names, name, ',');)
            if (name == controller)
                add_folders(sys + "/" + controller, path, folders);
    }
    return folders;
}

std::uint64_t cgroup_memory_limit(const std::string& proc, const std::string& sys)
{
    constexpr std::uint64_t kUnlimited = 1ull << 62; // for no limit, version 1 writes the largest count of whole pages, version 2 "max"
    std::uint64_t least = 0;
    for (const std::string& folder : cgroup_folders("memory", proc, sys))
        for (const char* name : {"/memory.max", "/memory.limit_in_bytes"}) {
            std::ifstream file(folder + name);
            std::uint64_t limit = 0;
            if (file >> limit && limit > 0 && limit < kUnlimited)
                least = least ? std::min(least, limit) : limit;
        }
    return least;
}

std::uint64_t usable_memory(const std::string& proc, const std::string& sys)
{
    const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    const std::uint64_t machine = pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 0;
    const std::uint64_t group = cgroup_memory_limit(proc, sys);
    return machine && group ? std::min(machine, group) : machine + group;
}

void bound_memory(int threads)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    static_cast<void>(threads);
#else
    constexpr std::uint64_t kStackBytes = 16ull << 20; // reserved by each thread, hardly used
    const std::uint64_t limit = usable_memory();
    struct rlimit now {};
    if (limit == 0 || ::getrlimit(RLIMIT_DATA, &now) != 0)
        return;
    const std::uint64_t bound = limit + kStackBytes * static_cast<std::uint64_t>(std::max(1, threads));
    if (now.rlim_cur != RLIM_INFINITY && now.rlim_cur <= bound)
        return;
    const std::lock_guard lock(bound_mutex);
    found_limit = now.rlim_cur, own_limit = bound;
    set_data_limit(bound); // a failure leaves the old bound
#endif
}

UnboundMemory::UnboundMemory()
{
    const std::lock_guard lock(bound_mutex);
    if (unbound++ == 0 && own_limit != 0)
        set_data_limit(found_limit);
}

UnboundMemory::~UnboundMemory()
{
    const std::lock_guard lock(bound_mutex);
    if (--unbound == 0 && own_limit != 0)
        set_data_limit(own_limit);
}

} // namespace burnish
