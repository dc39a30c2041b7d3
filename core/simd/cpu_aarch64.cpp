#include <cstdio>
#include <memory>

#include "core/simd/cpu.h"

namespace burnish {

// Reads the implementer and the part from a register, because the kernel tells no brand.
std::string cpu_name()
{
    const char* const path = "/sys/devices/system/cpu/cpu0/regs/identification/midr_el1";
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "r"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
    unsigned long long midr = 0;
    if (!file || std::fscanf(file.get(), "%llx", &midr) != 1)
        return "unknown processor";
    char text[64];
    std::snprintf(text, sizeof text, "aarch64, implementer 0x%02llx part 0x%03llx", midr >> 24 & 0xff, midr >> 4 & 0xfff);
    return text;
}

} // namespace burnish
