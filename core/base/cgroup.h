// Limits that Linux control groups set on this process (cgroups(7), versions 1 and 2).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace burnish {

// Returns the control-group folders that bound the process: the process's own group first, then its ancestors. Version
// 1 groups count only for `controller` ("memory"); version 2 groups always count. A container may see its own group as
// the root, and then returns only this group. `proc` and `sys` are the paths where Linux shows the groups.
std::vector<std::string> cgroup_folders(const std::string& controller, const std::string& proc = "/proc/self/cgroup",
                                        const std::string& sys = "/sys/fs/cgroup");

// Returns the smallest memory limit in bytes, or 0 for no limit.
std::uint64_t cgroup_memory_limit(const std::string& proc = "/proc/self/cgroup", const std::string& sys = "/sys/fs/cgroup");

// Returns the groups' limit or the machine's memory in bytes, the smaller.
std::uint64_t usable_memory(const std::string& proc = "/proc/self/cgroup", const std::string& sys = "/sys/fs/cgroup");

// Lets allocations fail that exceed usable_memory(), in place of swapping or being killed without a message. Bounds the
// process's data (RLIMIT_DATA) by it plus the stacks that `threads` threads reserve. Does nothing where sanitizers keep
// shadows of all memory.
void bound_memory(int threads);

// Restores the limit that bound_memory() found, as long as an object lives: children inherit limits where they start. Any thread.
class UnboundMemory {
  public:
    UnboundMemory();
    ~UnboundMemory();
    UnboundMemory(const UnboundMemory&) = delete;
    UnboundMemory& operator=(const UnboundMemory&) = delete;
};

} // namespace burnish
