// Tests of one instruction set's lanes. Sets that this processor does not support are reported as skipped.
#pragma once
#include <gtest/gtest.h>
#include <string>

#include "core/simd/dispatch.h"
#include "tests/unit/simd/ops.h"

namespace burnish {

inline void PrintTo(Isa isa, std::ostream* out)
{
    *out << isa_name(isa);
} // the name in gtest and ctest

class OnIsa : public testing::TestWithParam<Isa> {
  protected:
    void SetUp() override
    {
        if (!isa_available(GetParam()))
            GTEST_SKIP() << "this processor has no " << isa_name(GetParam());
    }
    const LaneFns& fns() const { return pick<LaneFns>(GetParam()); }
};

inline std::string isa_case_name(const testing::TestParamInfo<Isa>& info)
{
    return isa_name(info.param);
}

} // namespace burnish
