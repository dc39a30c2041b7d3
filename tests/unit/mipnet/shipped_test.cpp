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
    for (const Lobe lobe : {Lobe::ggx_aniso, Lobe::beckmann, Lobe::ashikhmin_shirley}) {
        SCOPED_TRACE(lobe_name(lobe));
        const Weights* w = shipped_weights(lobe);
        ASSERT_NE(w, nullptr);
        EXPECT_EQ(w->shape.lobe, lobe);
        EXPECT_EQ(w->command.find(std::string("burnish train mip --brdf ") + lobe_name(lobe)), 0u);
        const std::vector<Summary> all = summaries(judge(set, lobe, {*w}, jobs));
        const Summary *base = nullptr, *net = nullptr, *kept = nullptr;
        for (const Summary& s : all)
            if (s.filter == "baseline")
                base = &s;
            else if (s.filter == "mipnet")
                net = &s;
            else if (s.filter == "mipnet auto")
                kept = &s;
        ASSERT_TRUE(base && net && kept);
        EXPECT_LT(net->mean.flip, 0.9 * base->mean.flip);
        EXPECT_LT(net->mean.l1, 0.95 * base->mean.l1);
        EXPECT_LT(net->mean.mse, 0.8 * base->mean.mse);
        EXPECT_LE(kept->worst_l1, 1.25); // 1.15 of a sample
        EXPECT_LE(kept->mean.l1, net->mean.l1);
    }
}

} // namespace
} // namespace burnish::mipnet
