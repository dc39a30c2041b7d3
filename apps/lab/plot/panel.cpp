#include "apps/lab/plot/panel.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace burnish {
namespace {

constexpr int kDensityCells = 150; // density cells along a side
constexpr double kShades = 96.0;
constexpr int kContourCells = 150; // along a side of the contour grid
constexpr int kCirclePoints = 180;

Place grid_place(const Panel& panel, double column, double row, int cells)
{
    return {panel.reach * (2.0 * column / cells - 1.0), panel.reach * (1.0 - 2.0 * row / cells)};
}

} // namespace

bool Panel::holds(const Place& p) const
{
    return std::isfinite(p.x) && std::abs(p.x) <= reach && std::abs(p.y) <= reach;
}

double dot(const PlotVec& a, const PlotVec& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

PlotVec cross(const PlotVec& a, const PlotVec& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

PlotVec unit(const PlotVec& v)
{
    const double length = std::sqrt(dot(v, v));
    return {v.x / length, v.y / length, v.z / length};
}

PlotVec mix(const PlotVec& a, const PlotVec& b, double t)
{
    return unit({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t});
}

void draw_density(Drawing& out, const Panel& panel, Edge edge, const Density& density)
{
    std::vector<double> values;
    for (int row = 0; row < kDensityCells; ++row)
        for (int column = 0; column < kDensityCells; ++column)
            values.push_back(density(grid_place(panel, column + 0.5, row + 0.5, kDensityCells)));
    const double most = *std::max_element(values.begin(), values.end());
    if (!(most > 0.0))
        return;
    const double side = kSide / kDensityCells;
    for (int row = 0; row < kDensityCells; ++row) {
        const double y = grid_place(panel, 0.0, row + 0.5, kDensityCells).y;
        const double reach = edge == Edge::horizon ? std::sqrt(1.0 - y * y) : panel.reach;
        const auto [least, unused] = panel.at({-reach, y});
        const double greatest = panel.at({reach, y}).first;
        const auto shade_of = [&](int column) { // in steps too small to see
            return std::round(kShades * std::sqrt(std::max(values[static_cast<std::size_t>(row * kDensityCells + column)], 0.0) / most)) /
                   kShades;
        };
        for (int begin = 0, end; begin < kDensityCells; begin = end) { // a run of cells with one shade is one rectangle
            const double shade = shade_of(begin);
            for (end = begin + 1; end < kDensityCells && shade_of(end) == shade;)
                ++end;
            const double left = std::max(panel.left + side * begin, least), right = std::min(panel.left + side * end + 0.3, greatest);
            if (left < right)
                out.rectangle(left, panel.top + side * row, right - left, side + (row + 1 < kDensityCells ? 0.3 : 0.0), "",
                              Paint{255.0 - 215.0 * shade, 255.0 - 175.0 * shade, 255.0 - 105.0 * shade});
        }
    }
}

// Marching squares, one stroke a cell. A cell with two strokes is split by the value at its centre.
void draw_contour(Drawing& out, const Panel& panel, const Density& density, double level, const std::string& css_class)
{
    constexpr int kWide = kContourCells + 1;
    std::vector<double> values;
    for (int row = 0; row < kWide; ++row)
        for (int column = 0; column < kWide; ++column)
            values.push_back(density(grid_place(panel, column, row, kContourCells)) - level);
    const auto value = [&](int column, int row) { return values[static_cast<std::size_t>(row * kWide + column)]; };
    constexpr int kCorner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}; // around the cell
    for (int row = 0; row < kContourCells; ++row)
        for (int column = 0; column < kContourCells; ++column) {
            Points crossings;
            for (int edge = 0; edge < 4; ++edge) {
                const int x0 = column + kCorner[edge][0], y0 = row + kCorner[edge][1];
                const int x1 = column + kCorner[edge + 1][0], y1 = row + kCorner[edge + 1][1];
                const double a = value(x0, y0), b = value(x1, y1);
                if ((a > 0.0) == (b > 0.0))
                    continue;
                const double t = a / (a - b);
                crossings.push_back(panel.at(grid_place(panel, x0 + t * (x1 - x0), y0 + t * (y1 - y0), kContourCells)));
            }
            if (crossings.size() == 4) {
                const double middle = value(column, row) + value(column + 1, row) + value(column, row + 1) + value(column + 1, row + 1);
                if ((middle > 0.0) == (value(column, row) > 0.0)) // the first corner's side is connected: joins edges 0, 1 and 2, 3
                    out.line({crossings[0], crossings[1]}, css_class), out.line({crossings[2], crossings[3]}, css_class);
                else
                    out.line({crossings[0], crossings[3]}, css_class), out.line({crossings[1], crossings[2]}, css_class);
            } else if (crossings.size() == 2) {
                out.line(crossings, css_class);
            }
        }
}

Points line_of(const Panel& panel, const std::vector<PlotVec>& directions, const ToPlace& place)
{
    Points points;
    for (const PlotVec& direction : directions) {
        const Place p = place(direction);
        if (panel.holds(p))
            points.push_back(panel.at(p));
    }
    return points;
}

void draw_dot(Drawing& out, const Panel& panel, const Place& p, double radius, const std::string& family)
{
    if (!panel.holds(p))
        return;
    const auto [x, y] = panel.at(p);
    out.open("best " + family);
    out.disc(x, y, radius, "mark");
    out.close();
}

void draw_frame(Drawing& out, const Panel& panel, Edge edge)
{
    out.text(panel.left + kSide / 2.0, panel.top - 14.0, "title middle", panel.title);
    const double l = panel.left, t = panel.top, below = panel.top + kSide + 16.0;
    if (edge == Edge::slopes || edge == Edge::units) {
        out.line({{l, t}, {l + kSide, t}, {l + kSide, t + kSide}, {l, t + kSide}, {l, t}}, "grid");
        out.text(l + kSide, below, "tick end", fmt::format("{} to {:.3g}", edge == Edge::slopes ? "slopes" : "values", panel.reach));
        return;
    }
    Points circle;
    for (int i = 0; i <= kCirclePoints; ++i)
        circle.push_back(panel.at({std::cos(2.0 * kPi * i / kCirclePoints), std::sin(2.0 * kPi * i / kCirclePoints)}));
    out.line(circle, "grid");
    out.text(l + kSide, below, "tick end", edge == Edge::sphere ? "a sphere from afar" : "seen along the normal, to the horizon");
}

void draw_key(Drawing& out, double y, const std::vector<KeyEntry>& entries)
{
    double x = kGap;
    for (const KeyEntry& entry : entries) {
        out.open(std::string("best ") + entry.family);
        out.disc(x, y - 4.5, 4.5, "mark");
        out.close();
        out.text(x + 11.0, y, "name", entry.text);
        x += 40.0 + 8.2 * static_cast<double>(std::string(entry.text).size());
    }
}

} // namespace burnish
