#include "apps/compare/sequence_page.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/numbered.h"
#include "apps/compare/verdict.h"
#include "apps/report/axes.h"
#include "apps/report/drawing.h"
#include "apps/report/html.h"
#include "apps/report/labels.h"
#include "apps/report/svg.h"

namespace burnish {
namespace {

constexpr double kPlotWidth = 760.0, kPlotHeight = 330.0, kPlotLeft = 62.0, kPlotRight = 590.0, kPlotTop = 14.0, kPlotBottom = 276.0; // px
constexpr double kSpotRadius = 3.0;

struct FrameCurve {
    const char *key, *name, *tint;
};
constexpr FrameCurve kCurves[] = {
    {"flip_mean", "error", "c2"}, {"change", "change", "c1"}, {"reference_change", "reference's change", "c3"}};

// Draws errors and changes over the frames' numbers.
Drawing plot_frames(const Json& rows)
{
    Drawing out(kPlotWidth, kPlotHeight, "chart", "FLIP by frame: error, change from the frame before, and the reference's change");
    double most = 1e-6;
    for (const Json& row : rows)
        for (const FrameCurve& curve : kCurves)
            most = std::max(most, row.value(curve.key, 0.0));
    const Axis x = linear_axis(rows.front()["frame"].get<double>(), rows.back()["frame"].get<double>(), kPlotLeft, kPlotRight);
    const Axis y{0.0, 1.05 * most, kPlotBottom, kPlotTop, true};
    for (const double value : linear_ticks(x, 9)) {
        out.line({{x.at(value), kPlotTop}, {x.at(value), kPlotBottom}}, "grid");
        out.text(x.at(value), kPlotBottom + 18.0, "tick middle", number(value));
    }
    for (const double value : linear_ticks(y, 7)) {
        out.line({{kPlotLeft, y.at(value)}, {kPlotRight, y.at(value)}}, "grid");
        out.text(kPlotLeft - 7.0, y.at(value) + 4.5, "tick end", number(value));
    }
    out.text(0.5 * (kPlotLeft + kPlotRight), kPlotBottom + 40.0, "title middle", "frame");
    out.text(14.0, 0.5 * (kPlotTop + kPlotBottom), "title middle", "FLIP", -90.0);
    LabelPlacer placer(kPlotLeft, kPlotTop, kPlotWidth - 2.0, kPlotBottom);
    for (const FrameCurve& curve : kCurves) {
        Points points;
        for (const Json& row : rows)
            if (row.contains(curve.key))
                points.emplace_back(x.at(row["frame"].get<double>()), y.at(row[curve.key].get<double>()));
        if (points.empty())
            continue;
        out.open(curve.tint);
        out.line(points, "curve");
        for (const auto& [px, py] : points)
            out.disc(px, py, kSpotRadius, "mark");
        const PlacedLabel at = placer.place(curve.name, {points.back()});
        out.text(at.x, at.y, at.end ? "name end" : "name", curve.name);
        out.close();
    }
    return out;
}

} // namespace

Result<std::string> sequence_page(const CompareOptions& options, const Status& verdict, const Json& json, const Jobs& jobs)
{
    const int worst = json["worst_frame"].get<int>();
    CompareOptions one = options;
    one.reference = numbered(options.reference, worst), one.test = numbered(options.test, worst);
    one.metrics = Metrics();
    const Result<Pictures> pictures = read_pictures(one, jobs);
    BN_TRY(pictures);
    const bool floats = pictures->reference.type == PixelType::f32, hdr = floats && !(options.metrics && options.metrics->flip);
    one.metrics->flip = !hdr, one.metrics->flip_hdr = hdr;
    const CompareFigures figures = compare_pictures(one, *pictures, jobs);
    ComparePage page{options.reference + " and " + options.test, verdict_html(options, verdict)};
    page.top += fmt::format("<p>{} frames: FLIP {:.6f} in the mean; flicker {:.6f}.</p>\n<figure>\n{}</figure>\n<h2>The worst frame: "
                            "{}</h2>\n",
                            json["frames"].get<std::size_t>(), json["flip_mean"].get<double>(), json["flicker"].get<double>(),
                            svg_of(plot_frames(json["by_frame"])), worst);
    return compare_page(page, one, figures, *pictures);
}

} // namespace burnish
