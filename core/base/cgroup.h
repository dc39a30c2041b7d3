// What the process's control groups grant it (Linux, cgroups(7), versions 1 and 2).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace burnish {

// The folders that bound the process, its own first, then those around it; `controller` ("memory") where it is of version 1, of version 2
// whatever it is. A container may see its own group as the root: then that is the only one. `proc` and `sys`: where Linux shows them.
std::vector<std::string> cgroup_folders(const std::string& controller, const std::string& proc = "/proc/self/cgroup",
                                        const std::string& sys = "/sys/fs/cgroup");

// The least limit on memory, bytes; 0: none.
std::uint64_t cgroup_memory_limit(const std::string& proc = "/proc/self/cgroup", const std::string& sys = "/sys/fs/cgroup");

// Lets allocations fail where the group's limit would end the process without a word: bounds its data (RLIMIT_DATA) by that limit and what
// the stacks of `threads` threads reserve. Nothing where there is no limit, or sanitizers keep shadows of all memory.
void bound_memory_by_cgroup(int threads);

} // namespace burnish
