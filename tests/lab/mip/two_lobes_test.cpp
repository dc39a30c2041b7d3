// Levels with two lobes per texel, against levels with one.
#include <gtest/gtest.h>

#include <vector>

#include "shading/bake/mip/mip_error.h"
#include "shading/bake/mip/optimised_mip.h"
#include "shading/lab/mip/two_lobes.h"
#include "tests/lab/mip/flat_texels.h"

namespace burnish {
namespace {

// With crossed grain, two lobes a texel err at least a quarter less than the best one, under other directions than the search used.
TEST(mip_optimiser, crossed_grain_wants_two_lobes)
{
    const Jobs jobs(2);
    const MipErrorSurface surface = mip_error_surface(mipnet::Lobe::ggx_aniso, true);
    mipnet::Texels grain = flat_texels(32, 0.3f);
    for (std::size_t i = 0; i < grain.count(); ++i) {
        const bool along = (i + i / 32) % 2 == 0;
        grain.channel[2][i] = along ? 0.5f : 0.06f, grain.channel[3][i] = along ? 0.06f : 0.5f;
    }
    const std::vector<mipnet::Texels> one = optimised_levels(grain, {{flat_texels(16, 0.3f)}}, surface, jobs);
    const LobePairs two = optimised_pairs(grain, one, surface, jobs), again = optimised_pairs(grain, one, surface, Jobs(1));
    EXPECT_EQ(two.first[0].channel[2], again.first[0].channel[2]);
    const auto errors = mip_errors(grain, {one, two.first}, surface, jobs, {.first = 1000, .times = 24, .lamps = 0}, {{}, two.second});
    EXPECT_LT(errors[1][0].l1, 0.75 * errors[0][0].l1);
    // Where one lobe suffices, two are no worse.
    const std::vector<mipnet::Texels> flat = {flat_texels(16, 0.3f)};
    const LobePairs same = optimised_pairs(flat_texels(32, 0.3f), flat, surface, jobs);
    EXPECT_LT(mip_errors(flat_texels(32, 0.3f), {same.first}, surface, jobs, {.times = 8, .lamps = 0}, {same.second})[0][0].l1, 2e-3);
}

} // namespace
} // namespace burnish
