// Option tables: rules for every row of every subcommand.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <memory>
#include <set>

#include "apps/chart/options.h"
#include "apps/cli/field_options.h"
#include "apps/compare/options.h"
#include "apps/options/options.h"
#include "apps/parity/options.h"

namespace burnish {
namespace {

struct Tables {
    RenderArguments render;
    ChartArguments chart;
    CompareArguments compare;
    ParityArguments parity;
    std::vector<std::pair<std::string, OptionTable>> all = {{"render", render_option_table(render)},
                                                            {"chart", chart_option_table(chart)},
                                                            {"compare", compare_option_table(compare)},
                                                            {"parity", parity_option_table(parity)}};
};

TEST(cli_options, names_and_letters_are_there_once)
{
    const Tables tables;
    for (const auto& [command, table] : tables.all) {
        std::set<std::string> names;
        for (const Option& option : table.options()) {
            EXPECT_TRUE(names.insert(option.name).second) << command << " " << option.name;
            if (option.letter) {
                EXPECT_TRUE(names.insert(std::string("-") + option.letter).second) << command << " -" << option.letter;
            }
            EXPECT_FALSE(option.help_text().empty()) << command << " " << option.name;
            EXPECT_EQ(option.help_text().find("{}"), std::string::npos) << command << " " << option.name;
        }
    }
}

TEST(cli_options, what_a_value_says_of_itself_can_be_given_back_to_it)
{
    Tables tables;
    int numbers = 0, names = 0;
    for (auto& [command, table] : tables.all)
        for (const Option& option : table.options()) {
            const std::string before = option.value.get();
            if (!option.takes_value() || before.empty() || option.initial)
                continue;
            EXPECT_TRUE(table.set(option.name, before)) << command << " " << option.name << " " << before;
            EXPECT_EQ(option.value.get(), before) << command << " " << option.name;
            numbers += option.value.kind == ValueKind::number || option.value.kind == ValueKind::integer;
            names += option.value.kind == ValueKind::name;
        }
    EXPECT_GT(numbers, 20);
    EXPECT_GT(names, 8);
}

TEST(cli_options, ranges_end_where_they_say_and_names_are_those_that_there_are)
{
    Tables tables;
    for (auto& [command, table] : tables.all)
        for (const Option& option : table.options()) {
            const Value& value = option.value;
            if (value.kind == ValueKind::integer) {
                for (const double inside : {value.low, value.high})
                    EXPECT_TRUE(table.set(option.name, std::to_string(static_cast<std::int64_t>(inside)))) << command << " " << option.name;
                for (const double outside : {value.low - 1.0, value.high + 1.0})
                    EXPECT_FALSE(table.set(option.name, std::to_string(static_cast<std::int64_t>(outside))))
                        << command << " " << option.name;
                EXPECT_FALSE(table.set(option.name, "1.5")) << command << " " << option.name;
            } else if (value.kind == ValueKind::number) {
                for (const double inside : {value.low, value.high})
                    EXPECT_TRUE(table.set(option.name, fmt::format("{:.17g}", inside))) << command << " " << option.name;
                for (const double outside : {value.low - 0.001, value.high * 1.001 + 0.001})
                    EXPECT_FALSE(table.set(option.name, fmt::format("{:.17g}", outside)))
                        << command << " " << option.name << " " << outside;
                EXPECT_FALSE(table.set(option.name, "nan")) << command << " " << option.name;
            } else if (value.kind == ValueKind::name || value.kind == ValueKind::names) {
                for (const std::string& name : value.names)
                    EXPECT_TRUE(table.set(option.name, name)) << command << " " << option.name << " " << name;
                const Status wrong = table.set(option.name, "nothing-such");
                EXPECT_EQ(static_cast<bool>(wrong), value.names.empty()) << command << " " << option.name;
            }
        }
}

TEST(cli_options, are_set_by_name_after_the_command_line_was_read)
{
    RenderArguments arguments;
    OptionTable table = render_option_table(arguments);
    ASSERT_TRUE(table.set("technique", "major_axis"));
    ASSERT_TRUE(table.set("samples", "4"));
    ASSERT_TRUE(table.set("--axis-k", "1.5"));
    ASSERT_TRUE(table.set("tilt", "20,-10"));
    ASSERT_TRUE(table.set("size", "64x32"));
    Result<RenderOptions> options = check_render_options(arguments, table);
    ASSERT_TRUE(options);
    EXPECT_EQ(options->frame.technique, "major_axis");
    EXPECT_EQ(options->frame.samples, 4);
    EXPECT_EQ(options->frame.major_axis_k, 1.5f);
    EXPECT_NEAR(static_cast<double>(options->frame.tilt_rad.x), 0.349066, 1e-6);
    EXPECT_EQ(options->frame.width, 64);
    EXPECT_FALSE(options->frame.override_anisotropy);
    ASSERT_TRUE(table.set("anisotropy", "0.5")); // again, on top of earlier values
    ASSERT_TRUE(table.set("samples", "9"));
    options = check_render_options(arguments, table);
    ASSERT_TRUE(options);
    EXPECT_TRUE(options->frame.override_anisotropy);
    EXPECT_EQ(options->frame.samples, 9);
    EXPECT_FALSE(table.set("no-such-option", "1"));
}

TEST(cli_options, stand_for_the_fields_that_libraries_name)
{
    RenderArguments arguments;
    OptionTable table = render_option_table(arguments);
    for (const auto& [field, option] : field_options())
        EXPECT_NE(table.find(option), nullptr) << field << " " << option;
    EXPECT_EQ(with_options("needs more than 8 bytes (Limits::texture_bytes)"), "needs more than 8 bytes (--limit-texture-bytes)");
    EXPECT_EQ(with_options("FrameDesc::major_axis_k 1, MipSettings::filter box: no"), "--axis-k 1, --mip-filter box: no");
    for (const char* word : {"", ":", "a::b", "FrameDesc::", "FrameDesc::brdf2", "xFrameDesc::brdf", "C:/maps/steel.png: 3"})
        EXPECT_EQ(with_options(word), word);
    EXPECT_EQ(line_of({ExitCode::usage, "", "", "of two kinds", "MaterialOverrides::material"}), "--material: of two kinds");
    EXPECT_EQ(line_of({ExitCode::usage, "a.gltf", "/x", "of two kinds", "VulkanOptions::device"}), "a.gltf: /x: --device: of two kinds");
}

TEST(cli_options, of_another_backend_are_refused)
{
    RenderArguments arguments;
    OptionTable table = render_option_table(arguments);
    ASSERT_TRUE(table.set("device", "lavapipe"));
    EXPECT_EQ(table.check_needs().error().line(), "--device: needs --backend vulkan");
    ASSERT_TRUE(table.set("backend", "vulkan"));
    EXPECT_TRUE(table.check_needs());
}

} // namespace
} // namespace burnish
