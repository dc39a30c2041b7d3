// The HTML page, its companion files and their images.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <gtest/gtest.h>

#include "apps/chart/page.h"
#include "apps/report/pictures.h"
#include "core/image/io/image_io.h"
#include "tests/unit/chart/sample.h"
#include "tests/unit/chart/xml.h"

namespace burnish {
namespace {

ChartReport report_with_pictures()
{
    ChartReport report = test::report();
    const std::string file = (std::filesystem::path(testing::TempDir()) / "chart_page_test.jpg").string();
    Image gray = make_image(8, 4, 3, PixelType::u8);
    EXPECT_TRUE(write_image(file, gray));
    for (ChartRow& row : report.rows) {
        row.picture = row.error_map = file;
        report.references[place(row)].picture = file;
    }
    return report;
}

TEST(chart_page, it_needs_nothing_else)
{
    const ChartReport report = report_with_pictures();
    const Result<std::string> page = chart_page(report);
    ASSERT_TRUE(page);
    EXPECT_EQ(page->find("http://www.w3.org/2000/svg") == std::string::npos, false);
    std::string rest = *page;
    for (std::size_t at; (at = rest.find("http://www.w3.org/2000/svg")) != std::string::npos;)
        rest.erase(at, 26); // a name, not an address
    for (const char* outside : {"http:", "https:", "src=\"/", "@import", "url("})
        EXPECT_EQ(rest.find(outside), std::string::npos) << outside;
    EXPECT_NE(page->find("data:image/jpeg;base64,"), std::string::npos);
    EXPECT_EQ(page->find("a<b>"), std::string::npos); // a scene's name is text
}

TEST(chart_page, it_says_what_the_reference_s_noise_is_worth)
{
    ChartReport report = report_with_pictures();
    EXPECT_NE(chart_page(report)->find("Its noise alone makes a mean HDR-FLIP of about 0.003"), std::string::npos);
    EXPECT_NE(chart_page(report)->find("within 1 %"), std::string::npos);
    report.references.begin()->second.noise = {64, static_cast<double>(INFINITY), static_cast<double>(NAN)};
    EXPECT_NE(chart_page(report)->find("too few to tell its noise"), std::string::npos);
}

TEST(chart_page, a_missing_picture_is_an_error)
{
    ChartReport report = report_with_pictures();
    report.rows[2].picture = "no/such/file.jpg";
    EXPECT_FALSE(chart_page(report));
}

TEST(chart_page, files_stand_alone)
{
    const std::vector<ReportFile> files = chart_files(report_with_pictures());
    ASSERT_EQ(files.size(), 3u);
    for (const ReportFile& svg : files) {
        EXPECT_TRUE(svg.name.ends_with(".svg")) << svg.name;
        EXPECT_EQ(test::xml_fault(svg.bytes), "") << svg.name;
        EXPECT_NE(svg.bytes.find("<style>"), std::string::npos) << svg.name;
    }
}

TEST(chart_page, pictures_shrink_to_means)
{
    Image image = make_image(5, 2, 1, PixelType::f32);
    for (int i = 0; i < 10; ++i)
        image.f32()[i] = static_cast<float>(i);
    const Image small = shrink(image, 2);
    ASSERT_EQ(small.width, 2);
    ASSERT_EQ(small.height, 1);
    EXPECT_FLOAT_EQ(small.f32()[0], (0 + 1 + 0.5f * 2 + 5 + 6 + 0.5f * 7) / 5.0f);
    EXPECT_FLOAT_EQ(small.f32()[1], (0.5f * 2 + 3 + 4 + 0.5f * 7 + 8 + 9) / 5.0f);
    EXPECT_EQ(shrink(image, 5).bytes, image.bytes);
    EXPECT_GE(picture_width(1), picture_width(1000));
    EXPECT_EQ(shrink_within(image, 2).bytes, small.bytes);
    EXPECT_EQ(shrink_within(image, 5).bytes, image.bytes);
    const Image tall = shrink_within(make_image(1, 1000, 1, PixelType::f32), 10);
    EXPECT_EQ(tall.width, 1);
    EXPECT_EQ(tall.height, 10);
}

} // namespace
} // namespace burnish
