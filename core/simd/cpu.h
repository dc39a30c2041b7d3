// Abilities of this processor and its operating system. Each machine has its own file cpu_MACHINE.cpp.
#pragma once
#include <string>

namespace burnish {
std::string cpu_name(); // returns the processor's brand string, or "unknown processor"
#ifdef __x86_64__
// Returns true where the processor has AVX2, FMA, F16C, BMI1, BMI2, LZCNT and MOVBE (x86-64-v3) and the system saves
// the registers.
bool cpu_has_avx2();
// Returns true where the processor also has AVX-512 F, BW, DQ, VL and CD (x86-64-v4) and the system saves the
// registers.
bool cpu_has_avx512();
#endif
} // namespace burnish
