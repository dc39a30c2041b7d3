// Prints the instruction sets of isa_list.h that this machine lacks, as a list of CMake. Run when the build is configured.
#include <cstdio>

#include "core/simd/cpu.h"

int main()
{
    std::printf("%s%s", burnish::cpu_has_avx2() ? "" : "avx2;", burnish::cpu_has_avx512() ? "" : "avx512");
}
