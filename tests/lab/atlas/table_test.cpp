// Golden figures: written, read and compared.
#include <gtest/gtest.h>

#include "apps/lab/atlas/assets.h"
#include "apps/lab/atlas/result_cache.h"

namespace burnish {
namespace {

const AtlasEntry kEntry = {
    "bent_normal_bends_too_far", "environment", "It breaks", "builtin:sphere", false, "anisotropy=0:1", AtlasReference::reference, "", 0.1,
    "--technique lobe_line"};

MeasuredEntry measured(double from, double to, double cure = 0.05)
{
    MeasuredEntry m;
    m.id = kEntry.id, m.kind = "approximation", m.in_double = 0.15;
    for (int i = 0; i <= 10; ++i)
        m.steps.push_back({i / 10.0, "anisotropy 0", from + (to - from) * i / 10.0, cure, 0.001, 0.002});
    m.steps[0].change = 0.0;
    summarise(kEntry, m);
    return m;
}

TEST(atlas_table, figures_follow_from_steps)
{
    const MeasuredEntry m = measured(0.0, 0.205);
    EXPECT_DOUBLE_EQ(m.onset, 0.5);
    EXPECT_DOUBLE_EQ(m.worst, 0.205);
    EXPECT_DOUBLE_EQ(m.cure_worst, 0.05);
    EXPECT_NEAR(m.flicker, 0.002, 1e-12);
    EXPECT_GT(measured(0.0, 0.09).onset, 1.0); // nowhere
}

TEST(atlas_table, what_is_written_is_read)
{
    GoldenTable table;
    table.walks["quick"][kEntry.id] = row_of(measured(0.0, 0.2));
    table.walks["full"]["mc_fireflies"] = {2.0, 0.09, -0.01, 0.0, std::nullopt, "none"};
    const auto back = parse_table(table_text(table), "golden_figures.txt");
    ASSERT_TRUE(back) << back.error().line();
    EXPECT_EQ(back->version, kTableVersion);
    const GoldenFigures& row = back->walks.at("quick").at(kEntry.id);
    EXPECT_DOUBLE_EQ(row.onset, 0.6);
    EXPECT_DOUBLE_EQ(row.worst, 0.2);
    EXPECT_EQ(row.kind, "approximation");
    EXPECT_DOUBLE_EQ(row.in_double.value(), 0.15);
    EXPECT_FALSE(back->walks.at("full").at("mc_fireflies").in_double);
    EXPECT_GT(back->walks.at("full").at("mc_fireflies").onset, 1.0);
    EXPECT_DOUBLE_EQ(back->walks.at("full").at("mc_fireflies").flicker, -0.01);
    EXPECT_EQ(table_text(*back), table_text(table));
}

TEST(atlas_table, what_is_no_table_is_refused)
{
    for (const char* text :
         {"", "# Where methods break\n", "Version 3\n\n## quick\n\n| a | b |\n", "Version 3\n| a | 0.5 | 0.1 | 0 | - | 0 | none |\n",
          "Version 3\n## quick\n| a | x | 0.1 | 0 | - | 0 | none |\n", "Version x\n"})
        EXPECT_FALSE(parse_table(text, "t.md")) << text;
    EXPECT_EQ(parse_table("Version 7\n## quick\n| a | b |\n", "t.md")->version, 7); // rows of another version have another meaning
}

TEST(atlas_table, the_onset_is_held_within_a_step_and_the_worst_within_a_twentieth)
{
    const MeasuredEntry m = measured(0.0, 0.205);
    const auto verdict = [&](double onset, double worst) {
        const GoldenFigures row = {onset, worst, 0.0, 0.05, 0.2, "approximation"};
        return judge(kEntry, m, &row).verdict;
    };
    EXPECT_EQ(verdict(0.5, 0.205), Verdict::held);
    EXPECT_EQ(verdict(0.4, 0.205), Verdict::held);
    EXPECT_EQ(verdict(0.6, 0.205), Verdict::held);
    EXPECT_EQ(verdict(0.7, 0.205), Verdict::worse);
    EXPECT_EQ(verdict(2.0, 0.205), Verdict::worse);
    EXPECT_EQ(verdict(0.3, 0.205), Verdict::better);
    EXPECT_EQ(verdict(0.5, 0.197), Verdict::held);
    EXPECT_EQ(verdict(0.5, 0.19), Verdict::worse);
    EXPECT_EQ(verdict(0.5, 0.22), Verdict::better);
    EXPECT_EQ(judge(kEntry, m, nullptr).verdict, Verdict::unknown);
}

TEST(atlas_table, another_kind_alone_is_held)
{
    MeasuredEntry m = measured(0.0, 0.2);
    const GoldenFigures row = {m.onset, m.worst, 0.0, 0.05, 0.2, "sampling"};
    EXPECT_EQ(judge(kEntry, m, &row).verdict, Verdict::held);
    m.kind = "none"; // no longer fails
    EXPECT_EQ(judge(kEntry, m, &row).verdict, Verdict::better);
}

TEST(atlas_table, a_cure_above_the_threshold_is_no_cure)
{
    const MeasuredEntry m = measured(0.0, 0.2, 0.11);
    const GoldenFigures row = row_of(m);
    EXPECT_EQ(judge(kEntry, m, &row).verdict, Verdict::uncured);
    AtlasEntry without = kEntry;
    without.cure = "";
    EXPECT_EQ(judge(without, m, &row).verdict, Verdict::held);
}

TEST(atlas_table, kept_entries_come_back_as_they_were)
{
    const MeasuredEntry m = measured(0.0, 1.0 / 3.0);
    const auto back = parse_cached_entry(cached_entry_json(m, "key"), "key");
    ASSERT_TRUE(back);
    ASSERT_EQ(back->steps.size(), m.steps.size());
    EXPECT_EQ(back->steps[7].error, m.steps[7].error);
    EXPECT_EQ(back->steps[7].cure_error, m.steps[7].cure_error);
    EXPECT_EQ(back->steps[7].values, m.steps[7].values);
    EXPECT_EQ(back->worst, m.worst);
    EXPECT_EQ(back->flicker, m.flicker);
    EXPECT_EQ(back->kind, m.kind);
    EXPECT_EQ(back->in_double, m.in_double);
    EXPECT_FALSE(parse_cached_entry(cached_entry_json(m, "key"), "other"));
    for (const char* text : {"", "[]", "{}", "{\"key\": \"key\"}", "{\"key\": \"key\", \"id\": \"nothing\", \"steps\": []}"})
        EXPECT_FALSE(parse_cached_entry(text, "key")) << text;
}

// No golden entry fails at its start, and cures hold. No golden row lacks an entry.
TEST(atlas_table, golden_entries_hold_at_their_start)
{
    const auto table = parse_table(std::string(kAtlasGolden.bytes, kAtlasGolden.size), "golden_figures.txt");
    ASSERT_TRUE(table) << table.error().line();
    EXPECT_EQ(table->version, kTableVersion);
    for (const auto& [walk, rows] : table->walks)
        for (const auto& [id, row] : rows) {
            const AtlasEntry* entry = find_entry(id);
            ASSERT_NE(entry, nullptr) << id;
            EXPECT_GT(row.onset, 0.0) << id << ": broken from the beginning";
            EXPECT_TRUE(!entry->cure[0] || row.cure_worst <= entry->threshold) << id << ": its cure fails";
        }
    for (const AtlasEntry& entry : atlas_entries())
        EXPECT_TRUE(table->walks.at("quick").count(entry.id)) << entry.id << " is not blessed";
}

} // namespace
} // namespace burnish
