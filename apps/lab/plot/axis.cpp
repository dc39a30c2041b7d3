#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <vector>

#include "apps/lab/plot/panel.h"
#include "apps/lab/plot/plot.h"
#include "apps/lab/plot/shapes.h"

namespace burnish {
namespace {

constexpr int kCurvePoints = 180;

struct Shapes { // as microfacet normals
    std::vector<PlotVec> ellipse, axis, between, samples;
    PlotVec near[2], far[2];
    PlotVec clamped[2], moved[2];              // farthest points clamped at the horizon, closest points moved as far: the lobe's width
    std::vector<std::vector<PlotVec>> circles; // directions at one distance from a sample's direction
};

// Returns the farthest point from the normal towards `end` whose mirror direction is above the horizon, as a share of the way.
double clamped_share(const PlotVec& end, const PlotVec& o)
{
    const auto at = [&](double share) { return unit({share * end.x, share * end.y, end.z}); };
    if (plot_fns().mirrored(end, o).z >= 0.0)
        return 1.0;
    double inside = 0.0, outside = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inside + outside);
        (plot_fns().mirrored(at(middle), o).z >= 0.0 ? inside : outside) = middle;
    }
    return inside;
}

Shapes shapes_of(const LobePlot& lobe, double alpha_x, double alpha_y, const PlotVec& o, const AxisShape& axis)
{
    const double rx = lobe.k * alpha_x / std::sqrt(2.0), ry = lobe.k * alpha_y / std::sqrt(2.0);
    Shapes s;
    // Sample the ellipse and its extrema
    for (int i = 0; i <= kCurvePoints; ++i)
        s.ellipse.push_back(plot_fns().normal_at(2.0 * kPi * i / kCurvePoints, rx, ry));
    for (int i = 0; i < 2; ++i) {
        s.near[i] = plot_fns().normal_at(axis.t_near + kPi * i, rx, ry);
        s.far[i] = plot_fns().normal_at(axis.t_far + kPi * i, rx, ry);
    }
    // Clamp the farthest points at the horizon, and move the closest points as far
    double share[2];
    for (int i = 0; i < 2; ++i) {
        share[i] = clamped_share(s.far[i], o);
        s.clamped[i] = unit({share[i] * s.far[i].x, share[i] * s.far[i].y, s.far[i].z});
    }
    const double turn_in = 0.5 * (share[0] - share[1]) * (axis.t_near - axis.t_far); // towards the end that is clamped less
    for (int i = 0; i < 2; ++i)
        s.moved[i] = plot_fns().normal_at(axis.t_near + kPi * i + (i == 0 ? -turn_in : turn_in), rx, ry);
    // Sample the major axis and place the technique's samples
    for (int i = 0; i <= kCurvePoints; ++i) {
        s.axis.push_back(mix(s.far[0], s.far[1], static_cast<double>(i) / kCurvePoints));
        s.between.push_back(mix(axis.ends[0], axis.ends[1], static_cast<double>(i) / kCurvePoints));
    }
    for (int i = 0; i < lobe.samples; ++i)
        s.samples.push_back(mix(axis.ends[0], axis.ends[1], lobe.samples == 1 ? 0.5 : static_cast<double>(i) / (lobe.samples - 1)));
    // Draw a circle of normals around each sample, for its extent in directions
    const double turn = 2.0 * std::asin(std::min(1.0, lobe.k * axis.radius / 2.0)); // angle between directions at this distance
    for (const PlotVec& w : s.samples) {
        const PlotVec d = plot_fns().mirrored(w, o);
        const PlotVec helper = std::abs(d.z) < 0.9 ? PlotVec{0, 0, 1} : PlotVec{1, 0, 0};
        const PlotVec a = unit(cross(d, helper)), b = cross(d, a);
        std::vector<PlotVec> circle;
        for (int i = 0; i <= 48; ++i) {
            const double t = 2.0 * kPi * i / 48, c = std::cos(turn), s1 = std::sin(turn) * std::cos(t), s2 = std::sin(turn) * std::sin(t);
            const PlotVec i_dir = {d.x * c + a.x * s1 + b.x * s2, d.y * c + a.y * s1 + b.y * s2, d.z * c + a.z * s1 + b.z * s2};
            circle.push_back(unit({o.x + i_dir.x, o.y + i_dir.y, o.z + i_dir.z})); // the normal that mirrors o to i_dir
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
        draw_dot(out, panel, place(s.clamped[i]), 2.5, "c5");
        draw_dot(out, panel, place(s.moved[i]), 2.5, "c3");
    }
    draw_dot(out, panel, place({0, 0, 1}), 3.5, "c0");
}

} // namespace

Drawing plot_axis(const LobePlot& lobe)
{
    // Order the widths and find the axis
    const double a = lobe.roughness * lobe.roughness;
    double alpha_x = std::max(a * (1.0 + lobe.anisotropy), 1e-3), alpha_y = std::max(a * (1.0 - lobe.anisotropy), 1e-3);
    const double theta = lobe.theta_deg * kPi / 180.0;
    double phi = lobe.phi_deg * kPi / 180.0;
    if (alpha_y > alpha_x) { // the ellipse frame has the larger width along x
        std::swap(alpha_x, alpha_y);
        phi -= kPi / 2.0;
    }
    const PlotVec o = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    AxisShape axis{};
    plot_fns().axis(alpha_x, alpha_y, o, lobe.k, lobe.beta, lobe.samples, axis);
    const Shapes shapes = shapes_of(lobe, alpha_x, alpha_y, o, axis);

    const double nan = std::nan("");
    Drawing out(3.0 * kSide + 4.0 * kGap, kTop + kSide + kBelow, "chart",
                fmt::format("Major axis of a lobe of roughness {:g} and eta {:g}", lobe.roughness, lobe.anisotropy));
    // Draw the three spaces: slopes, normals and reflected directions
    const Panel slopes{"slopes", kGap, 1.5 * lobe.k * alpha_x / std::sqrt(2.0)};
    draw_density(out, slopes, Edge::slopes, [&](const Place& p) {
        const PlotVec w = unit({p.x, p.y, 1.0});
        const double z2 = w.z * w.z;
        return plot_fns().normals(alpha_x, alpha_y, w) * z2 * z2; // slope density: D times the fourth power of the cosine
    });
    draw_frame(out, slopes, Edge::slopes);
    draw_shapes(out, slopes, shapes, [&](const PlotVec& w) { return w.z > 0.0 ? Place{w.x / w.z, w.y / w.z} : Place{nan, nan}; });

    const Panel normals{"microfacet normals", 2.0 * kGap + kSide, 1.0};
    draw_density(out, normals, Edge::horizon, [&](const Place& p) {
        const double z2 = 1.0 - p.x * p.x - p.y * p.y;
        return z2 > 0.0 ? plot_fns().normals(alpha_x, alpha_y, {p.x, p.y, std::sqrt(z2)}) : 0.0;
    });
    draw_frame(out, normals, Edge::horizon);
    draw_shapes(out, normals, shapes, [&](const PlotVec& w) { return w.z >= 0.0 ? Place{w.x, w.y} : Place{nan, nan}; });

    const Panel reflected{"reflected directions", 3.0 * kGap + 2.0 * kSide, 1.0};
    draw_density(out, reflected, Edge::horizon, [&](const Place& p) {
        const double z2 = 1.0 - p.x * p.x - p.y * p.y;
        return z2 > 0.0 ? plot_fns().lobe(alpha_x, alpha_y, o, {p.x, p.y, std::sqrt(z2)}) : 0.0;
    });
    draw_frame(out, reflected, Edge::horizon);
    draw_shapes(out, reflected, shapes, [&](const PlotVec& w) {
        const PlotVec i = plot_fns().mirrored(w, o);
        return i.z >= 0.0 ? Place{i.x, i.y} : Place{nan, nan};
    });
    // Measure the width between the moved points
    const PlotVec left = plot_fns().mirrored(shapes.moved[0], o), right = plot_fns().mirrored(shapes.moved[1], o);
    out.text(kGap, kTop + kSide + 44.0, "note",
             fmt::format("roughness {:g}, eta {:g}, seen from {:g} degrees off the normal, {:g} about it; k {:g}, beta {:g}, {} samples; "
                         "width {:.5f}, radius {:.5f}",
                         lobe.roughness, lobe.anisotropy, lobe.theta_deg, lobe.phi_deg, lobe.k, lobe.beta, lobe.samples,
                         std::hypot(left.x - right.x, left.y - right.y, left.z - right.z), axis.radius));
    draw_key(out, kTop + kSide + 74.0,
             {{"c0", "k deviations; mirror"},
              {"c4", "farthest"},
              {"c5", "clamped"},
              {"c1", "closest"},
              {"c3", "moved"},
              {"c2", "major axis, samples and their reach"}});
    return out;
}

} // namespace burnish
