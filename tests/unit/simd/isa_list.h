// The instruction sets that this processor runs; tests of the others are reported as skipped.
#pragma once
#include <gtest/gtest.h>
#include <ostream>
#include <string>

#include "core/simd/cpu.h"
#include "tests/unit/simd/ops.h"

namespace burnish {

struct IsaCase {
    const char* name;
    const LaneFns& (*fns)();
    bool runs;
};

inline void PrintTo(const IsaCase& isa, std::ostream* out)
{
    *out << isa.name;
} // what gtest and ctest call it

inline const IsaCase kIsaCases[] = {
    {"scalar", bn_scalar::lane_fns, true},
    {"avx2", bn_avx2::lane_fns, cpu_has_avx2()},
    {"avx512", bn_avx512::lane_fns, cpu_has_avx512()},
};

class OnIsa : public testing::TestWithParam<IsaCase> {
  protected:
    void SetUp() override
    {
        if (!GetParam().runs)
            GTEST_SKIP() << "this processor has no " << GetParam().name;
    }
    const LaneFns& fns() const { return GetParam().fns(); }
};

inline std::string isa_case_name(const testing::TestParamInfo<IsaCase>& info)
{
    return info.param.name;
}

} // namespace burnish
