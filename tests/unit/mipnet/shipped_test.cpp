// The cascades that are part of the program, against closed forms on families that they never saw.
#include <gtest/gtest.h>

#include "shading/bake/mipnet/evaluate.h"
#include "shading/bake/mipnet/shipped.h"

namespace burnish::mipnet {
namespace {

TEST(shipped, nets_beat_plain_means_on_families_never_seen)
{
    const Jobs jobs(2);
    std::vector<TestMaterial> set;
    for (const Family& f : families())
        if (f.held_out)
            set.push_back({make_material(f, kTestSeeds, 256), "held-out"});
    ASSERT_EQ(set.size(), 5u);
    const Weights* w = shipped_weights(Lobe::ggx_aniso);
    ASSERT_NE(w, nullptr);
    EXPECT_EQ(w->shape.lobe, Lobe::ggx_aniso);
    const std::vector<Summary> all = summaries(judge(set, Lobe::ggx_aniso, {*w}, jobs));
    const Summary *base = nullptr, *net = nullptr;
    for (const Summary& s : all)
        if (s.filter == "baseline" || s.filter == "mipnet")
            (s.filter == "baseline" ? base : net) = &s;
    ASSERT_TRUE(base && net);
    EXPECT_LT(net->mean.flip, 0.9 * base->mean.flip);
    EXPECT_LT(net->mean.l1, 0.95 * base->mean.l1);
    EXPECT_LT(net->mean.mse, 0.8 * base->mean.mse);
}

} // namespace
} // namespace burnish::mipnet
