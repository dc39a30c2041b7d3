// Charts as SVG: well-formed, complete, readable.
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>

#include "apps/chart/plots.h"
#include "apps/compare/histogram.h"
#include "apps/report/axes.h"
#include "apps/report/chart_style.h"
#include "apps/report/labels.h"
#include "apps/report/svg.h"
#include "raster/frame/frame.h"
#include "tests/unit/chart/sample.h"
#include "tests/unit/chart/xml.h"

namespace burnish {
namespace {

using test::xml_fault;

RowList list_of(const ChartReport& report)
{
    RowList rows;
    for (const ChartRow& row : report.rows)
        rows.push_back(&row);
    return rows;
}

int count(const std::string& text, const std::string& what)
{
    int found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++found;
    return found;
}

TEST(chart_svg, the_reader_of_xml_finds_faults)
{
    EXPECT_EQ(xml_fault("<a b=\"1\"><c/>x &amp; y</a>"), "");
    for (const char* bad :
         {"", "<a>", "<a></b>", "<a/><b/>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>", "<a>&x;</a>", "<a>&</a>", "<a b=\"<\"/>", "x<a/>"})
        EXPECT_NE(xml_fault(bad), "") << bad;
}

TEST(chart_svg, what_users_name_does_not_become_markup)
{
    Drawing drawing(100, 50, "chart", "\"<&>");
    drawing.open("point", {{"aria-label", "a\"b<c>&\n"}}, "</title><script>");
    drawing.text(1, 2, "tick", "1 < 2 & 3 > 2");
    drawing.close();
    const std::string text = svg_of(drawing, chart_style());
    EXPECT_EQ(xml_fault(text), "") << text;
    EXPECT_EQ(text.find("<script>"), std::string::npos);
}

TEST(chart_svg, every_setting_is_a_point_that_says_what_it_is)
{
    ChartReport report = test::report();
    mark_pareto(report.rows);
    const RowList rows = list_of(report);
    for (const Layout layout : {Layout::wide, Layout::narrow})
        for (const Drawing& drawing :
             {plot_time_flip(rows, layout), plot_samples(rows, Quantity::flip, layout), plot_samples(rows, Quantity::time, layout)}) {
            const std::string svg = svg_of(drawing);
            EXPECT_EQ(xml_fault(svg), "") << svg;
            for (const char* key : {"0b", "0c"})
                EXPECT_EQ(count(svg, "data-row=\"" + std::string(key) + "\""), 1) << svg;
            EXPECT_NE(svg.find("aria-label=\"major_axis, 16 samples: 5 ms, FLIP 0.0625\""), std::string::npos) << svg;
            EXPECT_EQ(count(svg, ">bent_normal</text>"), 1);
            EXPECT_NE(svg.find("(ms)</text>") != std::string::npos,
                      svg.find("samples of a fragment") != std::string::npos && svg.find("mean FLIP") != std::string::npos);
        }
    EXPECT_NE(svg_of(plot_time_flip(rows, Layout::wide)).find("Pareto front"), std::string::npos);
}

TEST(chart_svg, odd_figures_are_drawn_or_left_out)
{
    ChartReport report = test::report();
    report.rows[0].measured.errors.flip_mean = 0.0; // has no logarithm
    report.rows[1].measured.errors.flip_mean = std::numeric_limits<double>::quiet_NaN();
    const std::string svg = svg_of(plot_time_flip(list_of(report), Layout::wide));
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
    EXPECT_EQ(count(svg, "data-row=\"0b\""), 0);
    EXPECT_EQ(count(svg, "data-row=\"0a\""), 1);
    for (ChartRow& row : report.rows)
        row.measured.errors.flip_mean = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(xml_fault(svg_of(plot_time_flip(list_of(report), Layout::wide))), "");
    EXPECT_TRUE(plot_samples(list_of(report), Quantity::flip, Layout::wide).empty());
}

TEST(chart_svg, techniques_without_a_sweep_have_no_chart_of_samples)
{
    ChartReport report = test::report();
    report.rows.pop_back();
    EXPECT_TRUE(plot_samples(list_of(report), Quantity::flip, Layout::wide).empty());
}

TEST(chart_svg, heat_maps_need_cells_and_a_baseline)
{
    ChartReport report = test::report();
    EXPECT_TRUE(plot_heat(list_of(report), "major_axis", false).empty());
    for (ChartRow row : test::report().rows) {
        for (ChartRow& own : report.rows)
            own.cell = {0.25f, -0.5f};
        row.key += "2";
        row.cell = {0.5f, -0.5f};
        row.measured.errors.flip_mean *= 2.0;
        report.rows.push_back(row);
        if (report.rows.size() > 6)
            break;
    }
    for (std::size_t i = 3; i < report.rows.size(); ++i)
        report.rows[i].cell = {0.5f, -0.5f};
    const RowList rows = list_of(report);
    const std::string map = svg_of(plot_heat(rows, "major_axis", false)), difference = svg_of(plot_heat(rows, "major_axis", true));
    for (const std::string& svg : {map, difference})
        EXPECT_EQ(xml_fault(svg), "") << svg;
    EXPECT_EQ(count(map, "data-row"), 2); // 16 samples, the technique's default
    EXPECT_NE(map.find("0.062"), std::string::npos) << map;
    EXPECT_NE(difference.find("-0.188"), std::string::npos) << difference; // 0.0625 - 0.25
    EXPECT_TRUE(plot_heat(rows, "bent_normal", true).empty());
    RowList alone;
    for (const ChartRow* row : rows)
        if (row->setting.technique != "bent_normal")
            alone.push_back(row);
    EXPECT_TRUE(plot_heat(alone, "major_axis", true).empty());
}

TEST(chart_svg, techniques_differ_in_shape_and_shade_and_relatives_share_a_family)
{
    std::set<Points> shapes;
    std::set<std::string> shades;
    const std::string style = chart_style();
    for (const TechniqueInfo& technique : techniques()) {
        const Mark mark = mark_of(technique.name);
        shapes.insert(shape_outline(mark.shape, 0.0, 0.0, 5.0));
        const std::string classes = mark_class(technique.name), last = classes.substr(classes.rfind(' ') + 1); // as in style sheets
        EXPECT_EQ(count(style, "svg.chart ." + last + " { --c: var(--" + last + "); }"), 1) << technique.name;
        const std::size_t tint = style.find("--" + last + ": #");
        ASSERT_NE(tint, std::string::npos) << technique.name;
        shades.insert(style.substr(style.find('#', tint), 7)); // on light paper
    }
    EXPECT_EQ(shapes.size(), techniques().size());
    EXPECT_EQ(shades.size(), techniques().size());
    EXPECT_EQ(mark_of("major_axis").family, mark_of("major_axis_weighted").family);
    EXPECT_NE(mark_of("major_axis").family, mark_of("bent_normal").family);
    EXPECT_NE(mark_of("auto").family, mark_of("mc").family);
}

TEST(chart_svg, a_histogram_counts_every_pixel)
{
    Image error = make_image(4, 2, 1, PixelType::f32);
    const float values[] = {0.0f, 0.001f, 0.5f, 0.51f, 0.999f, 1.0f, 2.0f, 0.03f};
    std::copy(std::begin(values), std::end(values), error.f32());
    const std::vector<double> bins = histogram_of(error);
    EXPECT_EQ(bins[0], 2.0 / 8.0);
    EXPECT_EQ(bins[1], 1.0 / 8.0);
    EXPECT_EQ(bins[25], 2.0 / 8.0);
    EXPECT_EQ(bins.back(), 3.0 / 8.0);
    const std::string svg = svg_of(plot_histogram(error, {}));
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(count(svg, "<rect "), 4);
}

TEST(chart_svg, ticks_are_round_and_inside)
{
    for (const double high : {1.1, 3.0, 50.0, 7e4})
        for (const std::size_t most : {4u, 9u}) {
            const Axis axis = log_axis(1.0, high, 0.0, 100.0);
            const std::vector<double> ticks = log_ticks(axis, most);
            EXPECT_GE(ticks.size(), 2u) << high;
            for (const double tick : ticks)
                EXPECT_TRUE(tick >= axis.low && tick <= axis.high);
            EXPECT_LT(axis.at(1.0), axis.at(high));
        }
    EXPECT_EQ(doubling_ticks(log_axis(1.0, 64.0, 0.0, 1.0), 4).size(), 4u); // 1 4 16 64
    EXPECT_EQ(number(0.06254), "0.0625");
    EXPECT_EQ(number(1234.5), "1234");
    EXPECT_EQ(number(2.0), "2");
    EXPECT_EQ(number(0.0), "0");
}

TEST(chart_svg, names_do_not_lie_on_each_other)
{
    LabelPlacer placer(0, 0, 400, 300);
    const auto left = [](const PlacedLabel& label) { return label.end ? label.x - 35.0 : label.x; };
    const PlacedLabel a = placer.place("first", {{100, 100}}), b = placer.place("other", {{101, 101}}),
                      c = placer.place("third", {{100, 101}});
    for (const auto& [one, other] : {std::pair{a, b}, {a, c}, {b, c}})
        EXPECT_TRUE(std::abs(one.y - other.y) >= 14.0 || std::abs(left(one) - left(other)) >= 35.0) << one.y << " " << other.y;
    const PlacedLabel edge = placer.place("a long name at the edge", {{395, 200}});
    EXPECT_TRUE(edge.end);
}

} // namespace
} // namespace burnish
