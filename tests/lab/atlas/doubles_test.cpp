// Frames in double precision, and the failures that they remove.
#include <cmath>
#include <gtest/gtest.h>

#include "apps/lab/atlas/measure.h"

namespace burnish {
namespace {

AtlasEntry small(const char* id)
{
    AtlasEntry entry = *find_entry(id);
    static std::vector<std::string> words; // entries point to their words
    words.reserve(16);
    words.push_back(std::string(entry.words) + " --env-size 16 --env-samples 16 --no-cache");
    entry.words = words.back().c_str();
    return entry;
}

PictureCache room_of(Report& report)
{
    return PictureCache({std::make_shared<const Jobs>(1), best_isa(), {false, ""}, nullptr}, report);
}

TEST(atlas_doubles, draw_what_floats_draw_but_for_rounding)
{
    Report report(true, 0);
    PictureCache room = room_of(report);
    for (const char* id : {"bent_normal_bends_too_far", "axis_few_samples", "lamps_below_the_horizon", "tangents_left"}) {
        const auto setting = setting_of(small(id), AtlasRole::test, 0.5, 48, 0);
        ASSERT_TRUE(setting) << setting.error().line();
        const Result<Frame> floats = room.draw(*setting);
        const Result<std::optional<Frame>> doubles = room.draw_in_double(*setting);
        ASSERT_TRUE(floats) << floats.error().line();
        ASSERT_TRUE(doubles) << doubles.error().line();
        if (!*doubles)
            GTEST_SKIP() << "no lanes of doubles";
        double off = 0.0, all = 0.0;
        int differ = 0;
        for (std::size_t i = 0; i < 48u * 48u * 3u; ++i) {
            const float a = floats->color.f32()[i], b = (*doubles)->color.f32()[i];
            off += static_cast<double>(std::abs(a - b)), all += static_cast<double>(a), differ += a != b;
        }
        EXPECT_GT(differ, 100) << id;
        EXPECT_LT(off, 2e-4 * all) << id;
    }
}

TEST(atlas_doubles, what_goes_in_them_is_a_matter_of_precision)
{
    Report report(true, 0);
    PictureCache room = room_of(report);
    const AtlasWalk walk{"short", 3, 48, 16};
    const auto far = walk_entry(small("eye_far_away"), walk, room), fit = walk_entry(small("albedo_by_a_fit"), walk, room);
    if (!far && far.error().code == ExitCode::unavailable)
        GTEST_SKIP() << far.error().line();
    ASSERT_TRUE(far) << far.error().line();
    ASSERT_TRUE(fit) << fit.error().line();
    EXPECT_EQ(far->measured.kind, "precision");
    EXPECT_EQ(far->measured.in_double, 0.0);
    EXPECT_EQ(fit->measured.kind, "approximation");
    EXPECT_NEAR(fit->measured.in_double.value(), fit->measured.worst, 0.01 * fit->measured.worst);
}

} // namespace
} // namespace burnish
