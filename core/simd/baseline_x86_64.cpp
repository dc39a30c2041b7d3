// Checks the processor before any other code runs. The rest of the program needs x86-64-v2. This file runs on every
// x86-64 processor, ahead of static objects: an older processor gets one line and ExitCode::unavailable, not an illegal
// instruction. The file uses no inline function from burnish or the C++ library, because the linker may keep another
// file's copy.
#include <cpuid.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

namespace {

constexpr int kUnavailable = 77;

struct Feature {
    const char* name;
    unsigned leaf, bit; // bit: in ecx
};
constexpr Feature kNeeded[] = {{"SSE3", 1, 0},    {"SSSE3", 1, 9},   {"CMPXCHG16B", 1, 13},        {"SSE4.1", 1, 19},
                               {"SSE4.2", 1, 20}, {"POPCNT", 1, 23}, {"LAHF/SAHF", 0x80000001u, 0}};

void check_processor(int, char**, char**)
{
    char missing[128] = "";
    for (const Feature& feature : kNeeded) {
        unsigned a = 0, b = 0, c = 0, d = 0;
        if (__get_cpuid(feature.leaf, &a, &b, &c, &d) && (c >> feature.bit & 1u) != 0)
            continue;
        if (missing[0])
            strcat(missing, ", ");
        strcat(missing, feature.name);
    }
    if (!missing[0])
        return;
    unsigned brand[13] = {}; // the last word is the terminating zero
    for (unsigned i = 0; i < 3; ++i)
        if (!__get_cpuid(0x80000002u + i, brand + 4 * i, brand + 4 * i + 1, brand + 4 * i + 2, brand + 4 * i + 3))
            brand[0] = 0;
    char name[sizeof brand];
    memcpy(name, brand, sizeof brand);
    dprintf(STDERR_FILENO, "burnish: an x86-64-v2 processor is needed; this one%s%s%s has no %s\n", name[0] ? " (" : "", name,
            name[0] ? ")" : "", missing);
    _exit(kUnavailable);
}

} // namespace

__attribute__((section(".preinit_array"), used)) static void (*const check_processor_first)(int, char**, char**) = check_processor;
