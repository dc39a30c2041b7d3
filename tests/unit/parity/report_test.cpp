// Verdicts and files of `burnish parity`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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

TEST(parity_report, holds_a_gpu_to_its_picture)
{
    const Frame a = two_pixels();
    Frame b = a;
    b.stages.pairs[1] ^= 1u;
    ParityRow row = row_of(a, b);
    EXPECT_FALSE(fault_of(row).empty()) << "a CPU device differs by a word";
    row.gpu = true;
    EXPECT_TRUE(fault_of(row).empty());
    row.flip_mean = kMaxFlipMean;
    EXPECT_NE(fault_of(row).find("FLIP"), std::string::npos);
}

TEST(parity_report, fails_where_rays_meet_another_triangle)
{
    const Frame a = two_pixels();
    ParityRow row = row_of(a, a);
    row.rays.samples = 8, row.rays.differ = 3;
    EXPECT_TRUE(passed(report_of({row})));
    row.rays.wrong = 1;
    EXPECT_NE(fault_of(row).find("than a ray"), std::string::npos);
    EXPECT_EQ(outcome(report_of({row})), ExitCode::differ);
    EXPECT_NE(parity_json(report_of({row})).find("\"ray_wrong\": 1"), std::string::npos);
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

} // namespace
} // namespace burnish::test
