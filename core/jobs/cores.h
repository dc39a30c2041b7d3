// Number of cores that this process may use.
#pragma once
namespace burnish {
// Upper bound on the threads of a Jobs object. More are never useful, and each would be started.
inline constexpr int kMostThreads = 1024;
// Returns the cores of the affinity mask, reduced to the control group's CPU quota. At least 1.
int usable_cores();
} // namespace burnish
