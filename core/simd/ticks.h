// The processor's own clock, for shares of a time. Cheap enough for inner loops; its unit differs between machines.
#pragma once
#include <cstdint>

namespace burnish {

static inline __attribute__((always_inline, unused)) std::uint64_t ticks()
{
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#elif defined(__aarch64__)
    std::uint64_t count;
    __asm__ volatile("mrs %0, cntvct_el0" : "=r"(count));
    return count;
#elif defined(__wasm__)
    return 0; // no clock that is cheap: profiles give no shares of a tile's time
#else
#error "this machine's counter"
#endif
}

} // namespace burnish
