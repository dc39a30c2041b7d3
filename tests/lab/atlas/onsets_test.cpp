// Limits of `burnish render --risks` are golden figures of the atlas. BN_BLESS=1 writes them.
#include <cstdlib>
#include <fmt/core.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "apps/lab/atlas/entries.h"
#include "apps/lab/atlas/golden_figures.h"

namespace burnish {
namespace {

const char* const kOnsetsFile = BN_SOURCE_DIR "/apps/risks/onsets.def";
constexpr const char* kOnsetsHead =
    R"(// Limits of the rules in risks.def: where each failure begins on its path, from 0 to 1. A rule without a line marks nothing.
// BN_BLESS=1 with unit_atlas.atlas_onsets.limits_of_rules_are_golden writes this file from golden figures of the quick walk.
)";

constexpr const char* kRuleEntries[] = {
#define BN_RISK(entry, measure, change, readers, says, words, kind, path) #entry,
#include "apps/risks/risks.def"
};

std::string text_of_file(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

// The file's golden figures, not the program's: both files change together, without a build between.
TEST(atlas_onsets, limits_of_rules_are_golden)
{
    const auto golden = parse_table(text_of_file(BN_SOURCE_DIR "/apps/lab/atlas/golden_figures.txt"), "golden_figures.txt");
    ASSERT_TRUE(golden) << golden.error().line();
    const auto& rows = golden->walks.at(kQuickWalk.name);
    std::string text = kOnsetsHead;
    for (const char* entry : kRuleEntries)
        if (const auto row = rows.find(entry); row != rows.end() && row->second.onset <= 1.0)
            text += fmt::format("BN_ONSET({}, {:.4f})\n", entry, row->second.onset);
    text += "#undef BN_ONSET\n";
    if (std::getenv("BN_BLESS"))
        std::ofstream(kOnsetsFile, std::ios::binary) << text;
    EXPECT_EQ(text_of_file(kOnsetsFile), text) << "BN_BLESS=1 writes apps/risks/onsets.def";
}

} // namespace
} // namespace burnish
