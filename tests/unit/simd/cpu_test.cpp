#include "core/simd/cpu.h"

#include <gtest/gtest.h>

namespace burnish {
namespace {

TEST(cpu, agrees_with_the_compilers_own_detection)
{
    __builtin_cpu_init();
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd");
    EXPECT_EQ(cpu_has_avx2(), avx2);
    EXPECT_EQ(cpu_has_avx512(), avx512);
    EXPECT_FALSE(cpu_name().empty());
}

} // namespace
} // namespace burnish
