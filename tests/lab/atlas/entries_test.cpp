// Every atlas line can be drawn, and every row of shading/models.def has an entry.
#include <cstdlib>
#include <gtest/gtest.h>
#include <set>

#include "apps/lab/atlas/entries.h"
#include "apps/options/animate.h"

namespace burnish {
namespace {

// Exceptions without an entry: a search serves as the reference for other filters.
const std::set<std::string> kWithout = {"mip filter teacher"};

TEST(atlas_entries, all_that_can_break_has_one)
{
    std::set<std::string> covered;
    for (const AtlasEntry& entry : atlas_entries()) {
        const auto of_entry = covered_by(entry);
        ASSERT_TRUE(of_entry) << of_entry.error().line();
        covered.insert(of_entry->begin(), of_entry->end());
    }
    for (const std::string& name : to_be_covered())
        EXPECT_NE(covered.count(name), kWithout.count(name))
            << name << " has no entry in apps/lab/atlas/atlas.def, or need not be excepted";
    EXPECT_GE(to_be_covered().size(), 25u);
}

TEST(atlas_entries, ids_are_words_and_none_is_twice)
{
    std::set<std::string> ids;
    for (const AtlasEntry& entry : atlas_entries()) {
        EXPECT_TRUE(ids.insert(entry.id).second) << entry.id;
        EXPECT_NE(find_entry(entry.id), nullptr);
        EXPECT_NE(std::string(entry.breaks).back(), '.') << entry.id;
        EXPECT_GT(entry.threshold, 0.0) << entry.id;
    }
    EXPECT_EQ(find_entry("nothing"), nullptr);
}

TEST(atlas_entries, every_step_of_every_role_is_a_setting)
{
    for (const AtlasEntry& entry : atlas_entries())
        for (const AtlasRole role : {AtlasRole::test, AtlasRole::cure, AtlasRole::reference})
            for (const double s : {0.0, 0.3, 1.0}) {
                const auto setting = setting_of(entry, role, s, 64, 512);
                ASSERT_TRUE(setting) << setting.error().line();
                EXPECT_EQ(setting->options.frame.width, 64);
                EXPECT_FALSE(setting->options.frame.background);
                EXPECT_EQ(setting->options.backend == "reference", role == AtlasRole::reference && is_path_traced(entry.reference));
                EXPECT_EQ(setting->in_double, role == AtlasRole::reference && entry.reference == AtlasReference::doubles);
            }
}

TEST(atlas_entries, paths_go_straight_or_by_factors)
{
    const OptionPath straight{"--roughness", {0.2}, {0.8}, false, false}, factors{"--axis-beta", {2.0}, {0.02}, false, true},
        whole{"--samples", {64.0}, {1.0}, true, true};
    EXPECT_DOUBLE_EQ(std::atof(value_at(straight, 0.5).c_str()), 0.5);
    EXPECT_DOUBLE_EQ(std::atof(value_at(factors, 0.5).c_str()), 0.2);
    EXPECT_EQ(value_at(whole, 0.5), "8");
    EXPECT_EQ(value_at(factors, 1.0), "0.02");
}

// The path sets the options, except where a role has separate words for them.
TEST(atlas_entries, a_role_s_own_words_stay)
{
    const AtlasEntry entry = {
        "few", "none", "", "builtin:sphere --technique mc", true, "samples=64:4", AtlasReference::reference, "", 0.1, "--samples 256"};
    EXPECT_EQ(setting_of(entry, AtlasRole::test, 0.0, 64, 512)->options.frame.samples, 64);
    EXPECT_EQ(setting_of(entry, AtlasRole::test, 1.0, 64, 512)->options.frame.samples, 4);
    EXPECT_EQ(setting_of(entry, AtlasRole::cure, 1.0, 64, 512)->options.frame.samples, 256);
    EXPECT_EQ(setting_of(entry, AtlasRole::reference, 1.0, 64, 512)->options.reference.samples, 512u);
}

TEST(atlas_entries, settings_of_one_scene_have_one_key)
{
    const AtlasEntry entry = {"keys",
                              "none",
                              "",
                              "builtin:sphere --light sphere:points=0,1,0:radius=0.1:radiance=9,9,9",
                              false,
                              "env-rotation=0:90",
                              AtlasReference::reference,
                              "",
                              0.1,
                              ""};
    AtlasEntry other = entry;
    other.words = "builtin:sphere --light sphere:points=0,1,0:radius=0.2:radiance=9,9,9";
    const auto a = setting_of(entry, AtlasRole::test, 0.0, 64, 512), b = setting_of(entry, AtlasRole::test, 1.0, 64, 512),
               c = setting_of(other, AtlasRole::test, 0.0, 64, 512), reference = setting_of(entry, AtlasRole::reference, 0.0, 64, 512);
    EXPECT_EQ(a->scene_key, b->scene_key);
    EXPECT_NE(a->environment_key, b->environment_key);
    EXPECT_NE(a->scene_key, c->scene_key);
    EXPECT_EQ(a->scene_key, reference->scene_key);
    EXPECT_EQ(a->environment_key, reference->environment_key);
}

} // namespace
} // namespace burnish
