// Prints the instruction sets of isa_list.h that this machine lacks, as a CMake list. Runs at configure time.
#include <cstdio>

#include "core/simd/cpu.h"

int main()
{
    std::printf("%s%s", burnish::cpu_has_avx2() ? "" : "avx2;", burnish::cpu_has_avx512() ? "" : "avx512");
}
