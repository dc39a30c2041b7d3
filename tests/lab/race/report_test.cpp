// Verdicts and files of `burnish race`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/lab/race/race_report.h"

namespace burnish::test {
namespace {

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
