#include "apps/chart/plots.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/report/axes.h"
#include "apps/report/labels.h"
#include "raster/frame/frame.h"

namespace burnish {
namespace {

constexpr double kRadius = 5.0, kHitRadius = 11.0; // px: marks, pointer targets

struct Point {
    double x = 0.0, y = 0.0, x_p95 = 0.0; // axis values; x_p95: end of a whisker from x; 0: no whisker
    const ChartRow* row = nullptr;
};

struct Curve {
    std::string technique;
    std::vector<Point> points;
    bool level = false; // one value for every x
};

struct Plot {
    std::string name, x_title, y_title;
    std::vector<Curve> curves;
    bool front = false;    // draws the Pareto front; marks off the front are hollow
    bool doubling = false; // x axis in powers of two
    bool linear = false;   // linear x axis
};

struct PlotArea { // axes of a plot
    double width, height, left, right, top, bottom;
    Axis x, y;
};

// Clamps to a positive value for a logarithmic axis: an exact technique lies at the lower edge.
double positive(double value, double least)
{
    return std::max(value, least);
}

PlotArea frame_of(Plot& plot, Layout layout)
{
    const bool wide = layout == Layout::wide;
    double least_x = 1e300, least_y = 1e300, most_x = -1e300, most_y = 0.0;
    for (const Curve& curve : plot.curves)
        for (const Point& p : curve.points) {
            if (p.y > 0.0)
                least_y = std::min(least_y, p.y);
            most_y = std::max(most_y, p.y);
            if (curve.level)
                continue;
            least_x = std::min(least_x, p.x);
            most_x = std::max(most_x, p.x_p95 > 0.0 ? std::max(p.x, p.x_p95) : p.x);
        }
    if (least_y > most_y)
        least_y = 1e-6, most_y = 1.0;
    if (least_x > most_x)
        least_x = most_x = 1.0;
    for (Curve& curve : plot.curves)
        for (Point& p : curve.points)
            p.y = positive(p.y, least_y / 2.0);
    // Curves over samples end at the right edge and need room for names there. In other plots names fit inside.
    const double names = wide ? 0.0 : 20.0 * static_cast<double>((plot.curves.size() + 1) / 2) + 8.0;
    PlotArea f{wide ? 650.0 : 380.0,
               wide ? 430.0 : 330.0 + names,
               62.0,
               !wide ? 368.0 : plot.front ? 638.0 : 496.0,
               14.0,
               wide ? 378.0 : 276.0,
               {},
               {}};
    f.x = plot.linear ? linear_axis(least_x, most_x, f.left, f.right) : log_axis(least_x, most_x, f.left, f.right);
    f.y = log_axis(least_y, most_y, f.bottom, f.top);
    return f;
}

void draw_axes(Drawing& out, const Plot& plot, const PlotArea& f, Layout layout)
{
    const bool wide = layout == Layout::wide;
    const std::size_t most = wide ? 9 : 6;
    for (const double value : plot.doubling ? doubling_ticks(f.x, wide ? 12 : 8)
                              : plot.linear ? linear_ticks(f.x, most)
                                            : log_ticks(f.x, most)) {
        out.line({{f.x.at(value), f.top}, {f.x.at(value), f.bottom}}, "grid");
        out.text(f.x.at(value), f.bottom + 18.0, "tick middle", number(value));
    }
    for (const double value : log_ticks(f.y, wide ? 9 : 7)) {
        out.line({{f.left, f.y.at(value)}, {f.right, f.y.at(value)}}, "grid");
        out.text(f.left - 7.0, f.y.at(value) + 4.5, "tick end", number(value));
    }
    out.text((f.left + f.right) / 2.0, f.bottom + 40.0, "title middle", plot.x_title);
    out.text(14.0, (f.top + f.bottom) / 2.0, "title middle", plot.y_title, -90.0);
}

void draw_front(Drawing& out, const Plot& plot, const PlotArea& f)
{
    Points front;
    for (const Curve& curve : plot.curves)
        for (const Point& p : curve.points)
            if (p.row->pareto)
                front.emplace_back(p.x, p.y);
    std::sort(front.begin(), front.end());
    Points steps;
    for (const auto& [x, y] : front) {
        if (!steps.empty())
            steps.emplace_back(f.x.at(x), steps.back().second);
        steps.emplace_back(f.x.at(x), f.y.at(y));
    }
    if (steps.empty())
        return;
    steps.emplace_back(f.right, steps.back().second);
    out.line(steps, "front");
    out.text(f.right - 4.0, steps.back().second + 16.0, "note end", "Pareto front");
}

void draw_point(Drawing& out, const PlotArea& f, const Point& p, const std::string& technique, bool filled)
{
    const double x = f.x.at(p.x), y = f.y.at(p.y);
    const std::string words = describe(*p.row);
    out.open(fmt::format("point {}{}", mark_class(technique), filled ? " best" : ""),
             {{"role", "img"}, {"aria-label", words}, {"data-row", p.row->key}}, words);
    if (p.x_p95 > p.x)
        out.line({{x, y}, {f.x.at(p.x_p95), y}}, "whisker");
    out.disc(x, y, kHitRadius, "hit");
    out.mark(mark_of(technique).shape, x, y, kRadius, "mark");
    out.close();
}

void draw_names_below(Drawing& out, const Plot& plot, const PlotArea& f)
{
    for (std::size_t i = 0; i < plot.curves.size(); ++i) {
        const std::string& name = plot.curves[i].technique;
        const double x = i % 2 ? f.width / 2.0 + 6.0 : 12.0, y = f.bottom + 66.0 + 20.0 * static_cast<double>(i / 2);
        out.open("point best " + mark_class(name));
        out.mark(mark_of(name).shape, x, y - 4.5, kRadius, "mark");
        out.close();
        out.text(x + 11.0, y, "name", name);
    }
}

void draw_names_beside(Drawing& out, const Plot& plot, const PlotArea& f)
{
    LabelPlacer placer(f.left, f.top, f.width - 2.0, f.bottom);
    for (const Curve& curve : plot.curves)
        for (const Point& p : curve.points)
            if (!curve.level)
                placer.add_mark(f.x.at(p.x), f.y.at(p.y));
    for (const Curve& curve : plot.curves) {
        Points at;
        for (const Point& p : curve.points)
            at.emplace_back(curve.level ? f.right : f.x.at(p.x), f.y.at(p.y));
        if (at.empty())
            continue;
        const PlacedLabel label = placer.place(curve.technique, at);
        out.text(label.x, label.y, "name " + mark_class(curve.technique) + (label.end ? " end" : ""), curve.technique);
    }
}

Drawing draw(Plot plot, Layout layout)
{
    const PlotArea f = frame_of(plot, layout);
    Drawing out(f.width, f.height, layout == Layout::wide ? "chart wide" : "chart narrow", plot.name);
    draw_axes(out, plot, f, layout);
    if (plot.front)
        draw_front(out, plot, f);
    for (const Curve& curve : plot.curves) {
        Points line;
        for (const Point& p : curve.points)
            line.emplace_back(f.x.at(p.x), f.y.at(p.y));
        if (curve.level && !curve.points.empty())
            out.line({{f.left, f.y.at(curve.points[0].y)}, {f.right, f.y.at(curve.points[0].y)}}, "level " + mark_class(curve.technique));
        else if (line.size() > 1)
            out.line(line, "curve " + mark_class(curve.technique));
    }
    // Draws marks over names over lines: the halo of a name must not hide a mark.
    if (layout == Layout::wide)
        draw_names_beside(out, plot, f);
    else
        draw_names_below(out, plot, f);
    for (const Curve& curve : plot.curves)
        for (const Point& p : curve.points)
            if (!curve.level)
                draw_point(out, f, p, curve.technique, p.row->pareto || !plot.front);
    return out;
}

RowList rows_of(const RowList& rows, const std::string& technique)
{
    RowList out;
    for (const ChartRow* row : rows)
        if (row->setting.technique == technique && std::isfinite(flip_of(*row)))
            out.push_back(row);
    return out;
}

} // namespace

std::string describe(const ChartRow& row)
{
    const std::string flip = std::isfinite(flip_of(row)) ? "FLIP " + number(flip_of(row))
                                                         : fmt::format("{} pixels are NaN or Inf", row.measured.errors.nan_pixels);
    return fmt::format("{}: {} ms, {}", describe(row.setting), number(ms_of(row)), flip);
}

Mark mark_of(const std::string& technique)
{
    std::vector<std::string> families;
    std::vector<int> members;
    Mark mark;
    for (const TechniqueInfo& known : techniques()) {
        const std::string name = known.name;
        std::size_t family = 0; // first technique whose name is a prefix of this name
        while (family < families.size() && name.rfind(families[family], 0) != 0)
            ++family;
        if (family == families.size())
            families.push_back(name), members.push_back(0);
        mark.family = static_cast<int>(family), mark.relative = members[family]++;
        if (name == technique)
            return mark;
        ++mark.shape;
    }
    // auto, which chooses one of them, and plans, which choose several
    const int more = technique == kPlanned ? 1 : 0;
    mark.family = static_cast<int>(families.size()) + more, mark.relative = 0, mark.shape += more;
    return mark;
}

std::string mark_class(const std::string& technique)
{
    const Mark mark = mark_of(technique);
    const std::string family = fmt::format("c{}", mark.family);
    return mark.relative ? fmt::format("{0} {0}{1}", family, static_cast<char>('a' + mark.relative - 1)) : family;
}

std::vector<std::string> techniques_of(const RowList& rows)
{
    std::vector<std::string> names;
    for (const ChartRow* row : rows)
        if (std::find(names.begin(), names.end(), row->setting.technique) == names.end())
            names.push_back(row->setting.technique);
    return names;
}

Drawing plot_time_flip(const RowList& rows, Layout layout)
{
    Plot plot{"Time against error", "median time of a frame (ms)", "mean FLIP error", {}, true, false};
    for (const std::string& technique : techniques_of(rows)) {
        Curve curve{technique, {}, false};
        for (const ChartRow* row : rows_of(rows, technique))
            curve.points.push_back({ms_of(*row), flip_of(*row), p95_of(*row), row});
        plot.curves.push_back(curve);
    }
    return draw(std::move(plot), layout);
}

namespace {

std::optional<double> swept(const ChartRow& row, const std::string& option)
{
    for (const auto& [name, value] : row.cell.others)
        if (name == option)
            return number_in(value);
    return std::nullopt;
}

// Returns true if the row differs from the first row in `option` alone.
bool only_differs_by(const ChartRow& row, const ChartRow& first, const std::string& option)
{
    if (row.cell.roughness != first.cell.roughness || row.cell.anisotropy != first.cell.anisotropy)
        return false;
    for (std::size_t i = 0; i < row.cell.others.size(); ++i)
        if (row.cell.others[i] != first.cell.others[i] && row.cell.others[i].first != option)
            return false;
    return true;
}

} // namespace

std::vector<std::string> swept_numbers(const RowList& rows)
{
    std::vector<std::string> names;
    for (const ChartRow* row : rows)
        for (const auto& [name, value] : row->cell.others)
            if (number_in(value) && std::find(names.begin(), names.end(), name) == names.end())
                names.push_back(name);
    return names;
}

Drawing plot_sweep(const RowList& rows, const std::string& option, Layout layout)
{
    Plot plot{"Error by " + option, option, "mean FLIP error", {}, false, false, true};
    bool any = false;
    for (const std::string& technique : techniques_of(rows)) {
        if (technique == kPlanned)
            continue; // plans change along the sweep
        Curve curve{technique, {}, false};
        std::vector<int> samples;
        for (const ChartRow* row : rows_of(rows, technique))
            samples.push_back(row->setting.samples);
        for (const ChartRow* row : rows_of(rows, technique))
            if (const std::optional<double> x = swept(*row, option);
                x && only_differs_by(*row, *rows.front(), option) && row->setting.samples == representative_samples(technique, samples))
                curve.points.push_back({*x, flip_of(*row), 0.0, row});
        std::sort(curve.points.begin(), curve.points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
        any = any || curve.points.size() > 1;
        plot.curves.push_back(curve);
    }
    return any ? draw(std::move(plot), layout) : Drawing();
}

Drawing plot_samples(const RowList& rows, Quantity quantity, Layout layout)
{
    const bool flip = quantity == Quantity::flip;
    Plot plot{flip ? "Error by number of samples" : "Time by number of samples",
              "samples of a fragment's lobe",
              flip ? "mean FLIP error" : "median time of a frame (ms)",
              {},
              false,
              true};
    bool any = false;
    for (const std::string& technique : techniques_of(rows)) {
        if (technique == kPlanned)
            continue; // its materials have counts of their own
        Curve curve{technique, {}, false};
        for (const ChartRow* row : rows_of(rows, technique)) {
            curve.level = !row->setting.sampled;
            curve.points.push_back({static_cast<double>(row->setting.samples), flip ? flip_of(*row) : ms_of(*row), 0.0, row});
        }
        any = any || curve.points.size() > 1;
        plot.curves.push_back(curve);
    }
    return any ? draw(std::move(plot), layout) : Drawing();
}

} // namespace burnish
