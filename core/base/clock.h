// Clocks for measurements, in milliseconds.
#pragma once
#include <time.h>

namespace burnish {

inline double clock_ms(clockid_t clock)
{
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}
inline double process_cpu_ms()
{
    return clock_ms(CLOCK_PROCESS_CPUTIME_ID);
} // summed over all threads of this process
inline double wall_ms()
{
    return clock_ms(CLOCK_MONOTONIC);
} // since a fixed but unspecified time

} // namespace burnish
