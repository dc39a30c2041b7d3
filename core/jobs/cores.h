// How many cores this process may use.
#pragma once
namespace burnish {
// The affinity mask, reduced to the CPU quota of the control group where one is set. At least 1.
int usable_cores();
} // namespace burnish
