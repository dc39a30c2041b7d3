#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <vector>

#include "apps/lab/plot/panel.h"
#include "apps/lab/plot/plot.h"
#include "apps/lab/plot/shapes.h"
#include "raster/frame/frame.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr int kGrid = 200;                          // grid positions along a side in the search for the peak
constexpr double kShares[] = {0.9, 0.5, 0.1, 0.01}; // contour levels, as shares of the peak
constexpr int kCutPoints = 1440;                    // over half a circle

// Lifts a point of the disk to a direction above the horizon. Returns false outside the disk.
bool risen(const Place& p, PlotVec& w)
{
    const double z2 = 1.0 - p.x * p.x - p.y * p.y;
    w = {p.x, p.y, std::sqrt(std::max(z2, 0.0))};
    return z2 > 0.0;
}

Place seen_along_normal(const PlotVec& w)
{
    return w.z >= 0.0 ? Place{w.x, w.y} : Place{std::nan(""), std::nan("")};
}

// Finds the maximum of the density: the best of a grid and of `likely`, refined uphill with ever smaller steps.
Place peak_of(const Density& density, const std::vector<PlotVec>& likely)
{
    Place best;
    double most = -1.0;
    const auto look = [&](const Place& p) {
        const double value = density(p);
        if (!(value > most))
            return false;
        most = value, best = p;
        return true;
    };
    for (const PlotVec& w : likely)
        if (w.z > 0.0)
            look({w.x, w.y});
    for (int row = 0; row <= kGrid; ++row)
        for (int column = 0; column <= kGrid; ++column)
            look({2.0 * column / kGrid - 1.0, 2.0 * row / kGrid - 1.0});
    for (double step = 1.0 / kGrid; step > 1e-10;) {
        const Place from = best;
        const bool higher = look({from.x + step, from.y}) || look({from.x - step, from.y}) || look({from.x, from.y + step}) ||
                            look({from.x, from.y - step});
        if (!higher)
            step *= 0.5;
    }
    return best;
}

// Draws a polar cut: values in directions from -90 to 90 degrees about `up`, towards `side`, as distances from the centre.
void draw_cut(Drawing& out, const Panel& panel, const std::function<double(const PlotVec&)>& value, const PlotVec& up, const PlotVec& side,
              const std::string& family)
{
    Points points;
    for (int i = 0; i <= kCutPoints; ++i) {
        const double angle = kPi * (static_cast<double>(i) / kCutPoints - 0.5), c = std::cos(angle), s = std::sin(angle);
        const PlotVec w = {up.x * c + side.x * s, up.y * c + side.y * s, up.z * c + side.z * s};
        const double length = w.z > 0.0 ? value(w) : 0.0;
        points.push_back(panel.at({length * s, length * c}));
    }
    out.open(family);
    out.line(points, "curve");
    out.close();
}

void draw_ray(Drawing& out, const Panel& panel, double angle, const std::string& family)
{
    out.open(family);
    out.line({panel.at({0.0, 0.0}), panel.at({panel.reach * std::sin(angle), panel.reach * std::cos(angle)})}, "level");
    out.close();
}

std::string degrees(const PlotVec& w)
{
    return fmt::format("{:.2f},{:.2f}", std::acos(std::clamp(w.z, -1.0, 1.0)) / kDegree, std::atan2(w.y, w.x) / kDegree);
}

} // namespace

Drawing plot_lobe(const LobePlot& plot)
{
    const double a = plot.roughness * plot.roughness, theta = plot.theta_deg * kDegree, phi = plot.phi_deg * kDegree;
    const LobeInPlace lobe = {plot.model, std::max(a * (1.0 + plot.anisotropy), 1e-3), std::max(a * (1.0 - plot.anisotropy), 1e-3),
                              plot.tilt_x_deg * kDegree, plot.tilt_y_deg * kDegree};
    const PlotVec o = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    const PlotVec normal = {0, 0, 1}, mirror = plot_fns().mirrored(normal, o), common = plot_fns().peak_normal(lobe);
    const auto value = [&](const PlotVec& w) { return plot_fns().value(lobe, o, w); };
    // Find the peak over all reflected directions
    const Density reflected = [&](const Place& p) {
        PlotVec w;
        return risen(p, w) ? value(w) : 0.0;
    };
    const Place peak_place = peak_of(reflected, {mirror, plot_fns().mirrored(common, o)});
    PlotVec peak;
    risen(peak_place, peak);
    const double most = value(peak), sine = std::hypot(peak.x, peak.y);
    const PlotVec towards = sine > 1e-6 ? PlotVec{peak.x / sine, peak.y / sine, 0.0} : PlotVec{1, 0, 0};

    Drawing out(4.0 * kSide + 5.0 * kGap, kTop + kSide + kBelow, "chart",
                fmt::format("Lobe {} of roughness {:g} and eta {:g}", lobe_model(plot.model).name, plot.roughness, plot.anisotropy));
    // Draw the visible half vectors
    const Panel halves{"half vectors that the eye sees", kGap, 1.0};
    const Density half = [&](const Place& p) {
        PlotVec h;
        return risen(p, h) ? plot_fns().visible(lobe, o, h) : 0.0;
    };
    draw_density(out, halves, Edge::horizon, half);
    draw_frame(out, halves, Edge::horizon);
    draw_dot(out, halves, {0.0, 0.0}, 3.5, "c0");
    if (lobe_traits_of(plot.model) & kLies_surface)
        draw_dot(out, halves, seen_along_normal(common), 3.5, "c2");

    // Draw the reflected directions with contours
    const Panel directions{"reflected directions", 2.0 * kGap + kSide, 1.0};
    draw_density(out, directions, Edge::horizon, reflected);
    out.open("c1");
    for (const double share : kShares)
        draw_contour(out, directions, reflected, share * most, "curve");
    out.close();
    draw_frame(out, directions, Edge::horizon);
    draw_dot(out, directions, seen_along_normal(mirror), 3.5, "c3");
    draw_dot(out, directions, peak_place, 3.5, "c4");

    // Draw the cuts through the peak
    const Panel upright{"cut through normal and peak, normal up", 3.0 * kGap + 2.0 * kSide, 1.05 * most};
    draw_frame(out, upright, Edge::units);
    draw_ray(out, upright, 0.0, "c0");
    draw_ray(out, upright, std::acos(std::clamp(peak.z, -1.0, 1.0)), "c4");
    draw_cut(out, upright, value, normal, towards, "c1");
    const Panel across{"cut across that, peak up", 4.0 * kGap + 3.0 * kSide, 1.05 * most};
    draw_frame(out, across, Edge::units);
    draw_ray(out, across, 0.0, "c4");
    draw_cut(out, across, value, peak, cross(normal, towards), "c1");

    // Write the caption and the key
    out.text(kGap, kTop + kSide + 44.0, "note",
             fmt::format(
                 "{}, roughness {:g}, eta {:g}, tilt {:g},{:g}; seen from {:g} degrees off the normal, {:g} about it; peak {:.5g} at {}, "
                 "mirror direction {:.5g} at {}",
                 lobe_model(plot.model).name, plot.roughness, plot.anisotropy, plot.tilt_x_deg, plot.tilt_y_deg, plot.theta_deg,
                 plot.phi_deg, most, degrees(peak), value(mirror), degrees(mirror)));
    draw_key(out, kTop + kSide + 74.0,
             {{"c0", "normal"},
              {"c2", "commonest normal"},
              {"c4", "peak"},
              {"c1", "lobe; 90, 50, 10, 1 % of the peak"},
              {"c3", "mirror direction"}});
    return out;
}

} // namespace burnish
