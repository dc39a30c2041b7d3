// What this processor and its operating system can run: a file cpu_MACHINE.cpp for each machine.
#pragma once
#include <string>

namespace burnish {
std::string cpu_name(); // the processor's brand string, or "unknown processor"
#ifdef __x86_64__
bool cpu_has_avx2();   // AVX2, FMA, F16C, BMI1, BMI2, LZCNT, MOVBE (x86-64-v3), with the registers saved by the
                       // system
bool cpu_has_avx512(); // the above and AVX-512 F, BW, DQ, VL, CD (x86-64-v4), with the registers saved by the
                       // system
#endif
} // namespace burnish
