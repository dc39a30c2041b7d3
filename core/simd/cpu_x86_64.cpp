#include "core/simd/cpu.h"

#include <cpuid.h>
#include <cstdint>
#include <cstring>

namespace burnish {
namespace {

struct Leaf {
    unsigned a = 0, b = 0, c = 0, d = 0;
};

Leaf leaf(unsigned index)
{
    Leaf l;
    if (!__get_cpuid_count(index, 0, &l.a, &l.b, &l.c, &l.d))
        return Leaf{};
    return l;
}

bool has(unsigned word, unsigned bits)
{
    return (word & bits) == bits;
}

// Returns XCR0, the mask of registers that the operating system saves; 0 where the system does not say.
unsigned saved_state()
{
    constexpr unsigned kOsxsave = 1u << 27;
    if (!has(leaf(1).c, kOsxsave))
        return 0;
    unsigned low = 0, high = 0;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

} // namespace

bool cpu_has_avx2()
{
    constexpr unsigned kFma = 1u << 12, kMovbe = 1u << 22, kAvx = 1u << 28, kF16c = 1u << 29; // leaf 1, ecx
    constexpr unsigned kBmi1 = 1u << 3, kAvx2 = 1u << 5, kBmi2 = 1u << 8;                     // leaf 7, ebx
    constexpr unsigned kLzcnt = 1u << 5;                                                      // leaf 0x80000001, ecx
    constexpr unsigned kXmmYmm = 0x6;
    static const bool found = has(leaf(1).c, kFma | kMovbe | kAvx | kF16c) && has(leaf(7).b, kBmi1 | kAvx2 | kBmi2) &&
                              has(leaf(0x80000001u).c, kLzcnt) && has(saved_state(), kXmmYmm);
    return found;
}

bool cpu_has_avx512()
{
    constexpr unsigned kF = 1u << 16, kDq = 1u << 17, kCd = 1u << 28, kBw = 1u << 30,
                       kVl = 1u << 31;       // leaf 7, ebx
    constexpr unsigned kAllRegisters = 0xe6; // xmm, ymm, opmask, upper halves of zmm0-15, zmm16-31
    static const bool found = cpu_has_avx2() && has(leaf(7).b, kF | kDq | kCd | kBw | kVl) && has(saved_state(), kAllRegisters);
    return found;
}

std::string cpu_name()
{
    constexpr unsigned kFirst = 0x80000002u, kLast = 0x80000004u;
    if (leaf(0x80000000u).a < kLast)
        return "unknown processor";
    char text[49] = {};
    for (unsigned i = kFirst; i <= kLast; ++i) {
        const Leaf l = leaf(i);
        const unsigned words[4] = {l.a, l.b, l.c, l.d};
        std::memcpy(text + (i - kFirst) * 16, words, 16);
    }
    std::string name(text);
    const std::size_t first = name.find_first_not_of(' '), last = name.find_last_not_of(' ');
    return first == std::string::npos ? "unknown processor" : name.substr(first, last - first + 1);
}

} // namespace burnish
