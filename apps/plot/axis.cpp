#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <functional>
#include <vector>

#include "apps/plot/plot.h"
#include "apps/plot/shapes.h"

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSide = 300.0, kGap = 24.0, kTop = 40.0, kBelow = 92.0; // px, of a panel and around it
constexpr int kCells = 75;                                               // of a density, along a side
constexpr int kCurvePoints = 180;

const PlotFns& fns()
{
    return FnsByIsa<PlotFns>::oracle(nullptr);
}

struct Place {
    double x = 0.0, y = 0.0;
};

// One space: a square of it and where that lies on paper.
struct Panel {
    const char* title;
    double left, reach; // px; how far from the middle to the edge, in units of the space
    std::pair<double, double> at(const Place& p) const
    {
        return {left + kSide * (0.5 + 0.5 * p.x / reach), kTop + kSide * (0.5 - 0.5 * p.y / reach)};
    }
    Place of_cell(int column, int row) const
    {
        return {reach * (2.0 * (column + 0.5) / kCells - 1.0), reach * (1.0 - 2.0 * (row + 0.5) / kCells)};
    }
};

PlotVec unit(const PlotVec& v)
{
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x / length, v.y / length, v.z / length};
}

PlotVec mix(const PlotVec& a, const PlotVec& b, double t)
{
    return unit({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t});
}

// Pale where the density is small, dark where it is large; the square root shows tails too.
void draw_density(Drawing& out, const Panel& panel, const std::function<double(const Place&)>& density)
{
    std::vector<double> values;
    for (int row = 0; row < kCells; ++row)
        for (int column = 0; column < kCells; ++column)
            values.push_back(density(panel.of_cell(column, row)));
    const double most = *std::max_element(values.begin(), values.end());
    if (!(most > 0.0))
        return;
    const double side = kSide / kCells;
    for (int row = 0; row < kCells; ++row)
        for (int column = 0; column < kCells; ++column) {
            const double shade = std::sqrt(values[static_cast<std::size_t>(row * kCells + column)] / most);
            if (shade < 0.02)
                continue;
            const Paint paint = {255.0 - 215.0 * shade, 255.0 - 175.0 * shade, 255.0 - 105.0 * shade};
            out.rectangle(panel.left + side * column, kTop + side * row, side + 0.3, side + 0.3, "", paint);
        }
}

using ToPlace = std::function<Place(const PlotVec& normal)>; // of a microfacet normal, in a space; NaN: not in it

Points line_of(const Panel& panel, const std::vector<PlotVec>& normals, const ToPlace& place)
{
    Points points;
    for (const PlotVec& normal : normals) {
        const Place p = place(normal);
        if (std::isfinite(p.x) && std::abs(p.x) <= panel.reach && std::abs(p.y) <= panel.reach)
            points.push_back(panel.at(p));
    }
    return points;
}

void draw_dot(Drawing& out, const Panel& panel, const Place& p, double radius, const std::string& family)
{
    if (!std::isfinite(p.x) || std::abs(p.x) > panel.reach || std::abs(p.y) > panel.reach)
        return;
    const auto [x, y] = panel.at(p);
    out.open("best " + family);
    out.disc(x, y, radius, "mark");
    out.close();
}

struct Shapes { // as microfacet normals
    std::vector<PlotVec> ellipse, axis, between, samples;
    PlotVec near[2], far[2];
    std::vector<std::vector<PlotVec>> circles; // of directions at one distance from a sample's
};

Shapes shapes_of(const LobePlot& lobe, double alpha_x, double alpha_y, const PlotVec& o, const AxisShape& axis)
{
    const double rx = lobe.k * alpha_x / std::sqrt(2.0), ry = lobe.k * alpha_y / std::sqrt(2.0);
    Shapes s;
    for (int i = 0; i <= kCurvePoints; ++i)
        s.ellipse.push_back(fns().normal_at(2.0 * kPi * i / kCurvePoints, rx, ry));
    for (int i = 0; i < 2; ++i) {
        s.near[i] = fns().normal_at(axis.t_near + kPi * i, rx, ry);
        s.far[i] = fns().normal_at(axis.t_far + kPi * i, rx, ry);
    }
    for (int i = 0; i <= kCurvePoints; ++i) {
        s.axis.push_back(mix(s.far[0], s.far[1], static_cast<double>(i) / kCurvePoints));
        s.between.push_back(mix(axis.ends[0], axis.ends[1], static_cast<double>(i) / kCurvePoints));
    }
    for (int i = 0; i < lobe.samples; ++i)
        s.samples.push_back(mix(axis.ends[0], axis.ends[1], lobe.samples == 1 ? 0.5 : static_cast<double>(i) / (lobe.samples - 1)));
    const double turn = 2.0 * std::asin(std::min(1.0, lobe.k * axis.radius / 2.0)); // of a direction, for that distance
    for (const PlotVec& w : s.samples) {
        const PlotVec d = fns().mirrored(w, o);
        const PlotVec helper = std::abs(d.z) < 0.9 ? PlotVec{0, 0, 1} : PlotVec{1, 0, 0};
        const PlotVec a = unit({d.y * helper.z - d.z * helper.y, d.z * helper.x - d.x * helper.z, d.x * helper.y - d.y * helper.x});
        const PlotVec b = {d.y * a.z - d.z * a.y, d.z * a.x - d.x * a.z, d.x * a.y - d.y * a.x};
        std::vector<PlotVec> circle;
        for (int i = 0; i <= 48; ++i) {
            const double t = 2.0 * kPi * i / 48, c = std::cos(turn), s1 = std::sin(turn) * std::cos(t), s2 = std::sin(turn) * std::sin(t);
            const PlotVec i_dir = {d.x * c + a.x * s1 + b.x * s2, d.y * c + a.y * s1 + b.y * s2, d.z * c + a.z * s1 + b.z * s2};
            circle.push_back(unit({o.x + i_dir.x, o.y + i_dir.y, o.z + i_dir.z})); // the normal that mirrors to it
        }
        s.circles.push_back(circle);
    }
    return s;
}

void draw_shapes(Drawing& out, const Panel& panel, const Shapes& s, const ToPlace& place)
{
    out.open("c0");
    out.line(line_of(panel, s.ellipse, place), "curve");
    out.close();
    out.open("c2");
    out.line(line_of(panel, s.axis, place), "level");
    out.line(line_of(panel, s.between, place), "curve");
    for (const std::vector<PlotVec>& circle : s.circles)
        out.line(line_of(panel, circle, place), "curve");
    out.close();
    for (const PlotVec& w : s.samples)
        draw_dot(out, panel, place(w), 2.5, "c2");
    for (int i = 0; i < 2; ++i) {
        draw_dot(out, panel, place(s.far[i]), 4.5, "c4");
        draw_dot(out, panel, place(s.near[i]), 4.5, "c1");
    }
    draw_dot(out, panel, place({0, 0, 1}), 3.5, "c0");
}

void draw_frame(Drawing& out, const Panel& panel, bool hemisphere)
{
    out.text(panel.left + kSide / 2.0, kTop - 14.0, "title middle", panel.title);
    const double l = panel.left, t = kTop;
    if (!hemisphere) {
        out.line({{l, t}, {l + kSide, t}, {l + kSide, t + kSide}, {l, t + kSide}, {l, t}}, "grid");
        out.text(l + kSide, t + kSide + 16.0, "tick end", fmt::format("slopes to {:.3g}", panel.reach));
        return;
    }
    Points circle;
    for (int i = 0; i <= kCurvePoints; ++i)
        circle.push_back(panel.at({std::cos(2.0 * kPi * i / kCurvePoints), std::sin(2.0 * kPi * i / kCurvePoints)}));
    out.line(circle, "grid");
    out.text(l + kSide, t + kSide + 16.0, "tick end", "seen along the normal, to the horizon");
}

void draw_key(Drawing& out, double y)
{
    const std::pair<const char*, const char*> entries[] = {
        {"c0", "k deviations; mirror direction"}, {"c4", "farthest"}, {"c1", "closest"}, {"c2", "major axis, samples and their reach"}};
    double x = kGap;
    for (const auto& [family, text] : entries) {
        out.open(std::string("best ") + family);
        out.disc(x, y - 4.5, 4.5, "mark");
        out.close();
        out.text(x + 11.0, y, "name", text);
        x += 40.0 + 7.6 * static_cast<double>(std::string(text).size());
    }
}

} // namespace

Drawing plot_axis(const LobePlot& lobe)
{
    const double a = lobe.roughness * lobe.roughness;
    double alpha_x = std::max(a * (1.0 + lobe.anisotropy), 1e-3), alpha_y = std::max(a * (1.0 - lobe.anisotropy), 1e-3);
    const double theta = lobe.theta_deg * kPi / 180.0;
    double phi = lobe.phi_deg * kPi / 180.0;
    if (alpha_y > alpha_x) { // the ellipse frame has the greater width along x
        std::swap(alpha_x, alpha_y);
        phi -= kPi / 2.0;
    }
    const PlotVec o = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    AxisShape axis{};
    fns().axis(alpha_x, alpha_y, o, lobe.k, lobe.beta, lobe.samples, axis);
    const Shapes shapes = shapes_of(lobe, alpha_x, alpha_y, o, axis);

    const double nan = std::nan("");
    Drawing out(3.0 * kSide + 4.0 * kGap, kTop + kSide + kBelow, "chart",
                fmt::format("Major axis of a lobe of alpha_lin {:g} and eta {:g}", lobe.roughness, lobe.anisotropy));
    const Panel slopes{"slopes", kGap, 1.5 * lobe.k * alpha_x / std::sqrt(2.0)};
    draw_density(out, slopes, [&](const Place& p) {
        const PlotVec w = unit({p.x, p.y, 1.0});
        const double z2 = w.z * w.z;
        return fns().normals(alpha_x, alpha_y, w) * z2 * z2; // of slopes: D times the fourth power of the cosine
    });
    draw_frame(out, slopes, false);
    draw_shapes(out, slopes, shapes, [&](const PlotVec& w) { return w.z > 0.0 ? Place{w.x / w.z, w.y / w.z} : Place{nan, nan}; });

    const Panel normals{"microfacet normals", 2.0 * kGap + kSide, 1.0};
    draw_density(out, normals, [&](const Place& p) {
        const double z2 = 1.0 - p.x * p.x - p.y * p.y;
        return z2 > 0.0 ? fns().normals(alpha_x, alpha_y, {p.x, p.y, std::sqrt(z2)}) : 0.0;
    });
    draw_frame(out, normals, true);
    draw_shapes(out, normals, shapes, [&](const PlotVec& w) { return w.z >= 0.0 ? Place{w.x, w.y} : Place{nan, nan}; });

    const Panel reflected{"reflected directions", 3.0 * kGap + 2.0 * kSide, 1.0};
    draw_density(out, reflected, [&](const Place& p) {
        const double z2 = 1.0 - p.x * p.x - p.y * p.y;
        return z2 > 0.0 ? fns().lobe(alpha_x, alpha_y, o, {p.x, p.y, std::sqrt(z2)}) : 0.0;
    });
    draw_frame(out, reflected, true);
    draw_shapes(out, reflected, shapes, [&](const PlotVec& w) {
        const PlotVec i = fns().mirrored(w, o);
        return i.z >= 0.0 ? Place{i.x, i.y} : Place{nan, nan};
    });
    out.text(kGap, kTop + kSide + 44.0, "note",
             fmt::format("alpha_lin {:g}, eta {:g}, seen from {:g} degrees off the normal, {:g} about it; k {:g}, beta {:g}, {} samples",
                         lobe.roughness, lobe.anisotropy, lobe.theta_deg, lobe.phi_deg, lobe.k, lobe.beta, lobe.samples));
    draw_key(out, kTop + kSide + 74.0);
    return out;
}

} // namespace burnish
