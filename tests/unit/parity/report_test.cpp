// Verdicts and files of `burnish parity` and `burnish race`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/parity/race_report.h"
#include "apps/parity/report.h"
#include "tests/unit/parity/frames.h"

namespace burnish::test {
namespace {

ParityRow row_of(const Frame& a, const Frame& b, const char* sampler = "exact", const char* pipeline = "ids")
{
    ParityRow row;
    row.scene = "a<b>.glb", row.technique = "mc", row.msaa = 2, row.sampler = sampler, row.pipeline = pipeline;
    row.counts = compare_stages(a, b, 2);
    row.causes = share_causes(pixel_causes(a, b, 2), a, 2, nullptr);
    return row;
}

ParityReport report_of(std::vector<ParityRow> rows)
{
    ParityReport report;
    report.device = "a & b", report.rows = std::move(rows);
    return report;
}

ParityRow failed(ExitCode code)
{
    ParityRow row = row_of(two_pixels(), two_pixels());
    row.counts = {}, row.causes = {};
    row.error = {code, "", "vulkan", "out of memory"};
    return row;
}

TEST(parity_report, passes_equal_rows_only)
{
    const Frame a = two_pixels();
    Frame b = a;
    b.stages.pairs[1] ^= 1u;
    EXPECT_TRUE(passed(report_of({row_of(a, a)})));
    EXPECT_EQ(outcome(report_of({row_of(a, a)})), ExitCode::ok);
    EXPECT_NE(fault_of(row_of(a, b)).find("interpolants"), std::string::npos);
    EXPECT_EQ(outcome(report_of({row_of(a, a), row_of(a, b)})), ExitCode::differ);
    EXPECT_TRUE(fault_of(row_of(a, b, "native", "forward")).empty()) << "looks the same";
    ParityRow other = row_of(a, b, "native", "forward");
    other.flip_mean = kMaxFlipMean;
    EXPECT_FALSE(fault_of(other).empty());
}

TEST(parity_report, allows_one_sample_in_a_million_in_all_rows_together)
{
    ParityRow row;
    row.sampler = "exact", row.pipeline = "ids";
    row.counts.samples = 1'000'000, row.counts.visibility_differ = 1;
    EXPECT_TRUE(passed(report_of({row})));
    EXPECT_EQ(outcome(report_of({row, row})), ExitCode::ok);
    row.counts.visibility_differ = 2;
    EXPECT_FALSE(visibility_fault(report_of({row})).empty());
    EXPECT_EQ(outcome(report_of({row})), ExitCode::differ);
}

TEST(parity_report, ends_with_the_code_of_a_row_that_failed)
{
    const Frame a = two_pixels();
    Frame b = a;
    b.stages.pairs[1] ^= 1u;
    const ParityRow good = row_of(a, a), bad = row_of(a, b), absent = failed(ExitCode::unavailable),
                    unreadable = failed(ExitCode::bad_input);
    EXPECT_FALSE(passed(report_of({good, absent})));
    EXPECT_EQ(outcome(report_of({good, absent})), ExitCode::unavailable);
    EXPECT_EQ(outcome(report_of({absent, unreadable})), ExitCode::bad_input);
    EXPECT_EQ(outcome(report_of({unreadable, absent})), ExitCode::bad_input);
    EXPECT_EQ(outcome(report_of({unreadable, bad})), ExitCode::differ);
}

TEST(parity_report, files_hold_rows_faults_and_causes)
{
    const Frame a = two_pixels();
    Frame b = a;
    b.stages.pairs[1] = 0, b.color.f32()[0] = 5.0f;
    const ParityReport report = report_of({row_of(a, b), failed(ExitCode::unavailable)});
    const nlohmann::json json = nlohmann::json::parse(parity_json(report));
    EXPECT_FALSE(json["passed"]);
    ASSERT_EQ(json["rows"].size(), 2u);
    EXPECT_EQ(json["rows"][0]["first_difference"], "interpolants");
    EXPECT_TRUE(json["rows"][0]["error"].is_null());
    EXPECT_EQ(json["rows"][0]["causes"][1]["stage"], "interpolants");
    EXPECT_EQ(json["rows"][0]["causes"][1]["pixels"], 1);
    EXPECT_EQ(json["rows"][1]["error"], "vulkan: out of memory");
    const std::string junit = parity_junit(report), html = parity_html(report), table = stage_table(report);
    EXPECT_NE(junit.find("failures=\"2\""), std::string::npos) << junit;
    EXPECT_NE(junit.find("a&lt;b&gt;.glb"), std::string::npos);
    EXPECT_NE(html.find("1 interpolants"), std::string::npos) << html;
    EXPECT_NE(html.find("vulkan: out of memory"), std::string::npos);
    EXPECT_EQ(html.find("a<b>"), std::string::npos);
    EXPECT_NE(table.find("pixels differ by"), std::string::npos) << table;
}

RaceRow raced(double tile_cpu, double device_cpu, double flip, const char* shader = "own")
{
    RaceRow row;
    row.shader = shader;
    row.scene.push_back('s'), row.technique.push_back('t'), row.device.push_back('d'); // GCC 12 warns about assignments
    row.tile_cpu_ms = tile_cpu, row.device_cpu_ms = device_cpu, row.flip_mean = row.flip_whole = flip;
    return row;
}

TEST(race_report, counts_rows_with_the_same_picture)
{
    RaceReport report;
    EXPECT_EQ(geomean_ratio(report, "own"), 0.0);
    report.rows = {raced(1, 2, 0), raced(1, 8, 0), raced(1, 1000, 0.02), raced(0, 0, 0), raced(1, 3, 0, "lean")};
    report.rows[3].error = "vulkan: out of memory";
    EXPECT_NEAR(geomean_ratio(report, "own"), 4.0, 1e-12);
    EXPECT_NEAR(geomean_ratio(report, "lean"), 3.0, 1e-12);
    const nlohmann::json json = nlohmann::json::parse(race_json(report));
    EXPECT_NEAR(json["geomean_ratio"]["own"].get<double>(), 4.0, 1e-12);
    EXPECT_NEAR(json["geomean_ratio"]["lean"].get<double>(), 3.0, 1e-12);
    EXPECT_EQ(json["rows"][4]["shader"], "lean");
    EXPECT_EQ(json["rows"][1]["ratio"], 8.0);
    EXPECT_TRUE(json["rows"][1]["error"].is_null());
    EXPECT_FALSE(json["rows"][2]["same_picture"]);
    EXPECT_EQ(json["rows"][3]["error"], "vulkan: out of memory");
    EXPECT_FALSE(json["rows"][3].contains("ratio"));
    const std::string table = race_table(report);
    EXPECT_NE(table.find("another picture"), std::string::npos);
    EXPECT_NE(table.find("out of memory"), std::string::npos);
}

// Two draws with two triangles each, two samples a pixel.
TEST(race_report, silhouettes_are_where_draws_meet)
{
    DrawTables tables;
    tables.draws.resize(2);
    tables.draws[0].triangle_count = 2, tables.draws[1].first_triangle = 2, tables.draws[1].triangle_count = 2;
    Frame frame;
    const std::uint32_t none = ~0u;
    for (const std::uint32_t id : {0u, 1u, 1u, 2u, none, none, none, 3u, 3u, 3u})
        frame.triangle_ids.push_back(id);
    EXPECT_EQ(silhouettes_of(frame, 2, tables), (std::vector<std::uint8_t>{0, 1, 0, 1, 0}));
}

TEST(race_report, a_difference_counts_away_from_silhouettes)
{
    Image reference = make_image(32, 32, 3, PixelType::f32);
    std::fill_n(reference.f32(), 3 * 32 * 32, 0.5f);
    Image test = reference;
    std::fill_n(test.f32() + 3 * 40, 3 * 200, 4.0f);
    std::vector<std::uint8_t> there(32 * 32), elsewhere(32 * 32);
    std::fill_n(there.begin() + 40, 200, std::uint8_t{1}), std::fill_n(elsewhere.begin() + 400, 200, std::uint8_t{1});
    RaceRow row;
    compare_pictures(reference, test, there, Jobs(1), row);
    EXPECT_EQ(row.flip_mean, 0.0);
    EXPECT_GT(row.flip_whole, kMaxWholeFlip);
    EXPECT_FALSE(same_picture(row)) << "a silhouette may differ, not by so much";
    EXPECT_NEAR(row.silhouettes, 200.0 / 1024.0, 1e-12);
    compare_pictures(reference, test, elsewhere, Jobs(1), row);
    EXPECT_NEAR(row.flip_mean, row.flip_whole / (1.0 - row.silhouettes), 1e-9);
    test.f32()[0] = std::numeric_limits<float>::quiet_NaN();
    compare_pictures(reference, test, there, Jobs(1), row);
    EXPECT_EQ(row.flip_mean, 1.0);
}

} // namespace
} // namespace burnish::test
