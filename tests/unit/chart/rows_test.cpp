// The Pareto front, cached rows of a chart, and their JSON.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "apps/chart/cpu_load.h"
#include "apps/report/json.h"
#include "tests/unit/chart/sample.h"

namespace burnish {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(chart_rows, the_front_is_what_nothing_beats)
{
    using Points = std::vector<std::pair<double, double>>;
    using Front = std::vector<bool>;
    EXPECT_EQ(pareto_front(Points{}), Front{});
    EXPECT_EQ(pareto_front(Points{{1, 3}, {2, 2}, {3, 1}}), (Front{true, true, true}));
    EXPECT_EQ(pareto_front(Points{{1, 3}, {2, 3}, {1, 4}, {3, 1}}), (Front{true, false, false, true}));
    EXPECT_EQ(pareto_front(Points{{1, 1}, {1, 1}}), (Front{true, true})); // neither is better
    EXPECT_EQ(pareto_front(Points{{1, kNan}, {2, 2}, {kNan, 0}}), (Front{false, true, false}));
    EXPECT_EQ(pareto_front(Points{{1, INFINITY}}), (Front{false}));
}

// Computes the front another way: sorted by time, a point is on the front if its error is below all errors of shorter times.
TEST(chart_rows, the_front_of_random_points)
{
    std::mt19937 random(7);
    for (int round = 0; round < 50; ++round) {
        std::vector<std::pair<double, double>> points;
        for (int i = 0; i < 40; ++i) // few values, for ties
            points.emplace_back(static_cast<double>(random() % 20), static_cast<double>(random() % 20));
        const std::vector<bool> front = pareto_front(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            double least_before = 1e9, least_same = 1e9;
            for (const auto& [x, y] : points) {
                if (x < points[i].first)
                    least_before = std::min(least_before, y);
                if (x == points[i].first)
                    least_same = std::min(least_same, y);
            }
            EXPECT_EQ(front[i], points[i].second < least_before && points[i].second <= least_same) << round << " " << i;
        }
    }
}

TEST(chart_rows, rows_are_compared_with_those_of_their_place_only)
{
    std::vector<ChartRow> rows = {test::row("a", "bent_normal", 1, 2.0, 0.5), test::row("b", "major_axis", 16, 3.0, 0.6),
                                  test::row("c", "major_axis", 16, 3.0, 0.6)};
    rows[2].cell.roughness = 0.5f;
    mark_pareto(rows);
    EXPECT_TRUE(rows[0].pareto);
    EXPECT_FALSE(rows[1].pareto);
    EXPECT_TRUE(rows[2].pareto);
}

TEST(chart_rows, the_fastest_within_an_error_is_named)
{
    const std::vector<ChartRow> all = {test::row("a", "bent_normal", 1, 2.0, 0.05), test::row("b", "major_axis", 4, 3.0, 0.02),
                                       test::row("c", "major_axis", 16, 2.5, 0.02)};
    std::vector<const ChartRow*> rows;
    for (const ChartRow& row : all)
        rows.push_back(&row);
    const std::vector<std::string> lines = wanted_settings(rows, {4096, 0.01, 0.003}, {0.001, 0.1, 0.03});
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0], "error 0.1: bent_normal, 2 ms, FLIP 0.05");
    EXPECT_EQ(lines[1], "error 0.03: major_axis, 16 samples, 2.5 ms, FLIP 0.02");
    EXPECT_EQ(lines[2], "error 0.001: none of these settings; the least is 0.02; the reference's own noise is larger");
    EXPECT_TRUE(wanted_settings({}, {}, {0.1}).empty());
}

TEST(chart_rows, kept_rows_come_back_as_they_were)
{
    ChartResults kept;
    std::map<std::string, Measured>& rows = kept.rows;
    rows["half"].ms = {1.25, 1.0 / 3.0};
    rows["half"].cpu_ms = {2.0, 3.0};
    rows["whole"] = test::row("whole", "mc", 4, 2.0, 0.125).measured;
    rows["bad"].has_errors = true;
    rows["bad"].errors = {kNan, kNan, kNan, kNan, 12, kNan, kNan, kNan};
    kept.references["place"] = {4096, 1.0 / 3.0, 0.001};
    kept.references["once"] = {64, INFINITY, kNan};
    const Result<ChartResults> back = parse_chart_results(chart_results_json(kept), "rows.json");
    ASSERT_TRUE(back);
    ASSERT_EQ(back->rows.size(), 3u);
    EXPECT_EQ(back->rows.at("half").ms, rows["half"].ms);
    EXPECT_EQ(back->rows.at("half").cpu_ms, rows["half"].cpu_ms);
    EXPECT_FALSE(back->rows.at("half").has_errors);
    EXPECT_EQ(back->rows.at("whole").errors.flip_mean, 0.125);
    EXPECT_EQ(back->rows.at("whole").errors.pattern_rms, 0.04);
    EXPECT_EQ(back->rows.at("whole").errors.quad_ratio_y, 0.9);
    EXPECT_TRUE(std::isnan(back->rows.at("bad").errors.flip_mean));
    EXPECT_EQ(back->rows.at("bad").errors.nan_pixels, 12u);
    ASSERT_EQ(back->references.size(), 2u);
    EXPECT_EQ(back->references.at("place").samples, 4096u);
    EXPECT_EQ(back->references.at("place").relative_error, 1.0 / 3.0);
    EXPECT_EQ(back->references.at("place").flip, 0.001);
    EXPECT_FALSE(std::isfinite(back->references.at("once").relative_error)); // one pass gives no error estimate
    EXPECT_FALSE(std::isfinite(back->references.at("once").flip));
}

TEST(chart_rows, a_file_that_holds_something_else_is_an_error)
{
    for (const char* text : {"", "[]", "{}", "{\"kept_version\": 3, \"references\": {}, \"rows\": {\"a\": {}}}",
                             "{\"kept_version\": 3, \"references\": {}, \"rows\": 3}", "{\"kept_version\": 3, \"rows\": {}}",
                             "{\"kept_version\": 3, \"references\": {\"a\": {\"samples\": \"x\"}}, \"rows\": {}}",
                             "{\"kept_version\": 3, \"references\": {}, \"rows\": {\"a\": {\"ms\": [\"x\"], \"cpu_ms\": []}}}",
                             "{\"kept_version\": 3, \"references\": {}, \"rows\": {\"a\": {\"ms\": [1, 2], \"cpu_ms\": [1]}}}"})
        EXPECT_FALSE(parse_chart_results(text, "rows.json")) << text;
    const Result<ChartResults> newer = parse_chart_results("{\"kept_version\": 99, \"rows\": {\"a\": 1}}", "rows.json");
    ASSERT_TRUE(newer); // rows of another version are dropped
    EXPECT_TRUE(newer->rows.empty());
}

TEST(chart_rows, the_report_holds_every_field)
{
    ChartReport report = test::report();
    report.rows[1].measured.errors = {kNan, kNan, kNan, kNan, 5, kNan, kNan, kNan};
    mark_pareto(report.rows);
    const nlohmann::json json = nlohmann::json::parse(report_json(report));
    ASSERT_EQ(json.at("rows").size(), report.rows.size());
    for (const char* field : {"scene", "env", "technique", "settings", "ms_median", "ms_p95", "flip_mean", "flip_p99", "rel_mse", "max_abs",
                              "pattern_rms", "quad_ratio_x", "quad_ratio_y", "nan_pixels", "pareto"})
        EXPECT_TRUE(json["rows"][0].contains(field)) << field;
    EXPECT_TRUE(json["rows"][1]["flip_mean"].is_null());
    EXPECT_EQ(json["rows"][1]["nan_pixels"], 5);
    EXPECT_FALSE(json["rows"][1]["pareto"].get<bool>());
    EXPECT_TRUE(json.at("machine").contains("processor"));
    ASSERT_EQ(json.at("references").size(), 1u); // one place
    EXPECT_EQ(json["references"][0]["env"], "builtin:studio");
    EXPECT_EQ(json["references"][0]["samples"], 4096);
    EXPECT_EQ(json["references"][0]["relative_error"], 0.01);
    EXPECT_EQ(json["references"][0]["flip_noise"], 0.003);
    EXPECT_TRUE(json["references"][0]["roughness"].is_null());
    EXPECT_EQ(json["rows"][0]["settings"]["width"], 64);
    EXPECT_EQ(json["rows"][0]["settings"]["error_width"], 32);
}

TEST(chart_rows, lines_by_commas_hold_plain_members_under_all_names)
{
    Json rows = Json::array();
    rows.push_back({{"name", "a \"b\", c"}, {"sub", Json({{"x", 1.5}, {"none", Json()}})}, {"list", Json::array({1, 2})}});
    rows.push_back({{"name", "plain"}, {"late", true}, {"nan", kNan}});
    EXPECT_EQ(csv_text(rows), "name,sub.x,sub.none,late,nan\n\"a \"\"b\"\", c\",1.5,,,\nplain,,,true,\n");
    EXPECT_EQ(csv_text(Json::array()), "\n");
}

TEST(chart_rows, ticks_of_the_machine_are_busy_ones_and_all)
{
    const auto ticks = ticks_of("cpu  100 20 30 400 50 6 7 8 90 0\ncpu0 1 2 3 4 5");
    ASSERT_TRUE(ticks);
    EXPECT_EQ(ticks->first, 171.0); // without idle and iowait; user already includes guests
    EXPECT_EQ(ticks->second, 621.0);
    for (const char* other : {"", "cpu", "cpu 1 2", "intr 1 2 3 4 5 6 7 8", "x"})
        EXPECT_FALSE(ticks_of(other)) << other;
}

} // namespace
} // namespace burnish
