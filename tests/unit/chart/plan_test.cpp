// Sweeps and their resulting settings.
#include <algorithm>
#include <gtest/gtest.h>

#include "apps/chart/plan.h"
#include "apps/cli/parse.h"
#include "raster/frame/frame.h"

namespace burnish {
namespace {

std::string fault_of(const std::string& text)
{
    Sweeps sweeps;
    const Status status = parse_sweep(text, sweeps);
    return status ? "" : status.error().line();
}

std::vector<int> samples_of(const std::vector<Setting>& settings)
{
    std::vector<int> samples;
    for (const Setting& setting : settings)
        samples.push_back(setting.samples);
    return samples;
}

TEST(chart_plan, sweeps_go_into_their_lists_once_and_in_order)
{
    Sweeps sweeps;
    ASSERT_TRUE(parse_sweep("samples=16,4,16,1", sweeps));
    ASSERT_TRUE(parse_sweep("roughness=0.5,0.1", sweeps));
    ASSERT_TRUE(parse_sweep("anisotropy=-0.9,-0,0", sweeps));
    EXPECT_EQ(sweeps.samples, (std::vector<int>{16, 4, 1}));
    EXPECT_EQ(sweeps.roughness, (std::vector<float>{0.5f, 0.1f}));
    EXPECT_EQ(sweeps.anisotropy, (std::vector<float>{-0.9f, 0.0f}));
}

TEST(chart_plan, wrong_sweeps_are_refused_with_what_was_expected)
{
    for (const auto& [text, needle] : {std::pair{"samples", "samples=1,4,16"},
                                       {"=1,2", "samples=1,4,16"},
                                       {"samples=", "samples=1,4,16"},
                                       {"samples=1,,2", "empty"},
                                       {"samples=1,", "empty"},
                                       {"samples=0", "--sweep"},
                                       {"samples=1.5", "--sweep"},
                                       {"samples=70000", "--sweep"},
                                       {"roughness=1.01", "--sweep"},
                                       {"roughness=nan", "--sweep"},
                                       {"anisotropy=-1.01", "--sweep"},
                                       {"anisotropy=x", "--sweep"}})
        EXPECT_NE(fault_of(text).find(needle), std::string::npos) << text << ": " << fault_of(text);
    Sweeps sweeps;
    ASSERT_TRUE(parse_sweep("samples=1", sweeps));
    EXPECT_FALSE(parse_sweep("samples=2", sweeps));
    std::string many = "samples=1";
    for (int i = 2; i <= 65; ++i)
        many.append(1, ',').append(std::to_string(i));
    EXPECT_NE(fault_of(many).find("65 values"), std::string::npos);
}

TEST(chart_plan, budgets_are_errors_above_0)
{
    std::vector<double> budgets;
    ASSERT_TRUE(parse_budgets("0.03,0.01,0.03", budgets));
    EXPECT_EQ(budgets, (std::vector<double>{0.03, 0.01}));
    for (const char* wrong : {"", "0", "-1", "2", "nan", "a", "0.1,,0.2", "0.1;0.2"})
        EXPECT_FALSE(parse_budgets(wrong, budgets)) << wrong;
}

TEST(chart_plan, techniques_by_name_in_the_registrys_order)
{
    const auto all = parse_techniques("all"), two = parse_techniques("major_axis,bent_normal");
    ASSERT_TRUE(all && two);
    EXPECT_EQ(all->size(), techniques().size());
    EXPECT_EQ(*two, (std::vector<std::string>{"bent_normal", "major_axis"}));
    EXPECT_FALSE(parse_techniques("major_axis,"));
    EXPECT_FALSE(parse_techniques("major"));
}

TEST(chart_plan, settings_follow_what_a_technique_makes_of_samples)
{
    EXPECT_EQ(samples_of(settings_of({"bent_normal"}, {2, 4})), (std::vector<int>{1}));
    EXPECT_EQ(samples_of(settings_of({"major_axis"}, {8, 2})), (std::vector<int>{2, 8}));
    EXPECT_EQ(samples_of(settings_of({"filtered_is"}, {4, 8, 9, 15})), (std::vector<int>{4, 9}));  // squares below
    EXPECT_EQ(samples_of(settings_of({"major_axis"}, {4, 100, 4096})), (std::vector<int>{4, 64})); // its maximum
    EXPECT_EQ(samples_of(settings_of({"mc"}, {4, 4096})), (std::vector<int>{4, 4096}));
    EXPECT_FALSE(settings_of({"bent_normal"}, {})[0].sampled);
    for (const TechniqueInfo& technique : techniques()) { // the default count is always present
        const std::vector<int> usual = samples_of(settings_of({technique.name}, {}));
        EXPECT_NE(std::find(usual.begin(), usual.end(), technique.default_samples), usual.end()) << technique.name;
        EXPECT_EQ(representative_samples(technique.name, usual), technique.default_samples);
    }
    EXPECT_EQ(representative_samples("major_axis", {1, 64, 12}), 12);
}

TEST(chart_plan, cells_are_all_pairs_or_the_scene_as_it_is)
{
    const std::vector<Cell> own = cells_of({});
    ASSERT_EQ(own.size(), 1u);
    EXPECT_FALSE(own[0].roughness || own[0].anisotropy);
    const std::vector<Cell> grid = cells_of({{}, {0.1f, 0.5f}, {-0.5f, 0.0f, 0.5f}, {}});
    ASSERT_EQ(grid.size(), 6u);
    EXPECT_EQ(grid[4], (Cell{0.5f, 0.0f}));
    EXPECT_EQ(describe(grid[0]), "roughness 0.1, anisotropy -0.5");
    Sweeps sweeps;
    ASSERT_TRUE(parse_sweep("roughness=0.1,0.5", sweeps));
    ASSERT_TRUE(parse_sweep("tilt=0,0:20,5:0,0", sweeps)); // vectors stay whole
    ASSERT_TRUE(parse_sweep("dfg=table,fit", sweeps));
    EXPECT_FALSE(parse_sweep("dfg=fit", sweeps));
    const std::vector<Cell> more = cells_of(sweeps);
    ASSERT_EQ(more.size(), 8u);
    EXPECT_EQ(describe(more[1]), "roughness 0.1, tilt 0,0, dfg fit");
    EXPECT_EQ(describe(more[6]), "roughness 0.5, tilt 20,5, dfg table");
}

} // namespace
} // namespace burnish
