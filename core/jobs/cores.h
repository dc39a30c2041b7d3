// How many cores this process may use.
#pragma once
namespace burnish {
// Threads of a Jobs object: more is never useful, and every one of them would be started.
inline constexpr int kMostThreads = 1024;
// The affinity mask, reduced to the CPU quota of the control group where one is set. At least 1.
int usable_cores();
} // namespace burnish
