// Which frames and materials may be drawn with records of constants (shading/inputs/stage_cxx.h).
#include <gtest/gtest.h>

#include "shading/inputs/stage_cxx.h"

namespace burnish {
namespace {

// A record that fits, and a list's members of other values, one after the other.
#define BN_FIT(member, value) record.member = Plain::member
#define BN_SPOIL(member, value)                                                                                                            \
    {                                                                                                                                      \
        auto other = record;                                                                                                               \
        other.member = Plain::member + 1;                                                                                                  \
        EXPECT_FALSE(Plain::fits(other)) << #member;                                                                                       \
    }
#define BN_EXPECT_CONDITIONS(constants, Name, Record)                                                                                      \
    {                                                                                                                                      \
        using Plain = Name;                                                                                                                \
        Record record = {};                                                                                                                \
        constants(BN_FIT) EXPECT_TRUE(Plain::fits(record));                                                                                \
        constants(BN_SPOIL)                                                                                                                \
    }

TEST(plain_records, fit_where_every_member_has_its_constant)
{
    BN_EXPECT_CONDITIONS(BN_PLAIN_FRAME, PlainFrame, ShadingFrame)
    BN_EXPECT_CONDITIONS(BN_PLAIN_MATERIAL, PlainMaterial, MaterialRecord)
    BN_EXPECT_CONDITIONS(BN_UNTABLED_MATERIAL, UntabledMaterial, MaterialRecord)
    BN_EXPECT_CONDITIONS(BN_ROUND_MATERIAL, RoundMaterial, MaterialRecord)
}

#undef BN_EXPECT_CONDITIONS
#undef BN_SPOIL
#undef BN_FIT

} // namespace
} // namespace burnish
