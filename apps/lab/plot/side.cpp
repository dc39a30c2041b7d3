// Tests on which side of the horizon a technique fetches a lobe's light: Cocco, Zanni, Chermain 2024, figure 20. A bent normal can flip
// the environment upside down.
#include <cmath>
#include <fmt/core.h>
#include <vector>

#include "apps/lab/plot/panel.h"
#include "apps/lab/plot/plot.h"
#include "apps/lab/plot/shapes.h"
#include "apps/report/axes.h"

namespace burnish {
namespace {

constexpr int kMapCells = 100, kShareCells = 60; // cells along a side: for the drawn sphere, for the statistics
constexpr int kMeanSamples = 8;                  // along a side of the lobe's sample grid
constexpr int kSteps = 20;                       // for eta from -0.95 to 0.95
constexpr double kMostEta = 0.95;

enum Looker { lobe_itself, bent_normal, major_axis, lookers };
constexpr const char* kNames[lookers] = {"the lobe's mean", "bent_normal", "major_axis, mean of samples"};

// Fetch directions in world space, from a point on the unit sphere seen along -z.
struct Looks {
    PlotVec along[lookers];
    bool wrong(int looker) const { return (along[looker].y > 0.0) != (along[lobe_itself].y > 0.0); }
};

Looks looks_at(const LobePlot& plot, double eta, const PlotVec& n)
{
    const double a = plot.roughness * plot.roughness;
    LobeInPlace lobe = {0, std::max(a * (1.0 + eta), 1e-3), std::max(a * (1.0 - eta), 1e-3), 0.0, 0.0};
    const PlotVec east = unit({n.z, 0.0, -n.x}), north = cross(n, east);
    const double c = std::cos(plot.rotation_deg * kDegree), s = std::sin(plot.rotation_deg * kDegree);
    PlotVec u = {east.x * c + north.x * s, east.y * c + north.y * s, east.z * c + north.z * s}, v = cross(n, u);
    if (lobe.alpha_y > lobe.alpha_x) {
        std::swap(lobe.alpha_x, lobe.alpha_y);
        const PlotVec old = u;
        u = v, v = {-old.x, -old.y, -old.z};
    }
    const PlotVec o = {u.z, v.z, n.z}; // to the eye: (0, 0, 1)
    Looks looks;
    looks.along[lobe_itself] = plot_fns().mean_direction(lobe, o, kMeanSamples);
    looks.along[bent_normal] = plot_fns().bent_direction(lobe, o);
    AxisShape axis{};
    plot_fns().axis(lobe.alpha_x, lobe.alpha_y, o, plot.k, plot.beta, plot.samples, axis);
    PlotVec sum = {0, 0, 0};
    for (int i = 0; i < plot.samples; ++i) {
        const double t = plot.samples == 1 ? 0.5 : static_cast<double>(i) / (plot.samples - 1);
        const PlotVec d = plot_fns().mirrored(mix(axis.ends[0], axis.ends[1], t), o);
        sum = {sum.x + d.x, sum.y + d.y, sum.z + d.z};
    }
    looks.along[major_axis] = sum;
    for (PlotVec& d : looks.along)
        d = {u.x * d.x + v.x * d.y + n.x * d.z, u.y * d.x + v.y * d.y + n.y * d.z, u.z * d.x + v.z * d.y + n.z * d.z};
    return looks;
}

// Calls `call` for every cell of a square whose centre shows the sphere. Cells lie beside the equator, never on it.
template <class Call> void each_cell(int cells, const Call& call)
{
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) {
            const double x = 2.0 * (column + 0.5) / cells - 1.0, y = 1.0 - 2.0 * (row + 0.5) / cells, z2 = 1.0 - x * x - y * y;
            if (z2 > 0.0)
                call(column, row, PlotVec{x, y, std::sqrt(z2)});
        }
}

struct Shares { // over the sphere's visible points, [0,1]
    double of[lookers];
};

Shares shares_of(const LobePlot& plot, double eta)
{
    double count = 0.0;
    Shares shares{};
    each_cell(kShareCells, [&](int, int, const PlotVec& n) {
        const Looks looks = looks_at(plot, eta, n);
        count += 1.0;
        for (int l = 0; l < lookers; ++l)
            shares.of[l] += looks.wrong(l) ? 1.0 : 0.0;
    });
    for (double& share : shares.of)
        share /= count;
    return shares;
}

// Light for directions up, dark for directions down, saturated for the wrong side.
Paint paint_of(bool up, bool wrong)
{
    if (wrong)
        return up ? Paint{235, 150, 110} : Paint{175, 70, 30};
    return up ? Paint{206, 222, 240} : Paint{130, 150, 175};
}

void draw_sphere(Drawing& out, const LobePlot& plot, int looker)
{
    const Panel panel{kNames[looker], kGap + looker * (kSide + kGap), 1.0};
    const double side = kSide / kMapCells;
    each_cell(kMapCells, [&](int column, int row, const PlotVec& n) {
        const Looks looks = looks_at(plot, plot.anisotropy, n);
        out.rectangle(panel.left + side * column, kTop + side * row, side + 0.3, side + 0.3, "",
                      paint_of(looks.along[looker].y > 0.0, looks.wrong(looker)));
    });
    draw_frame(out, panel, Edge::sphere);
}

void draw_shares(Drawing& out, const LobePlot& plot, double left)
{
    constexpr double kFoot = 26.0; // px, for the numbers below
    std::vector<double> etas;
    std::vector<Shares> shares;
    double most = 0.05;
    for (int i = 0; i <= kSteps; ++i) {
        etas.push_back(kMostEta * (2.0 * i / kSteps - 1.0));
        shares.push_back(shares_of(plot, etas.back()));
        for (const double share : shares.back().of)
            most = std::max(most, share);
    }
    const Axis x = linear_axis(-1.0, 1.0, left + 34.0, left + kSide), y = linear_axis(0.0, 100.0 * most, kTop + kSide - kFoot, kTop);
    out.text(left + kSide / 2.0, kTop - 14.0, "title middle", "points that look to the wrong side, %");
    for (const double tick : linear_ticks(y, 6)) {
        out.line({{x.from_px, y.at(tick)}, {x.to_px, y.at(tick)}}, "grid");
        out.text(x.from_px - 6.0, y.at(tick) + 4.0, "tick end", number(tick));
    }
    for (const double tick : linear_ticks(x, 5))
        out.text(x.at(tick), kTop + kSide - 8.0, "tick middle", number(tick));
    out.text(left + kSide, kTop + kSide + 16.0, "tick end", "eta");
    for (const auto& [looker, family] : {std::pair{bent_normal, "c1"}, std::pair{major_axis, "c2"}}) {
        Points points;
        for (std::size_t i = 0; i < etas.size(); ++i)
            points.push_back({x.at(etas[i]), y.at(100.0 * shares[i].of[looker])});
        out.open(std::string("best ") + family);
        out.line(points, "curve");
        for (const auto& [px, py] : points)
            out.disc(px, py, 2.0, "mark");
        out.close();
    }
}

} // namespace

Drawing plot_side(const LobePlot& plot)
{
    Drawing out(4.0 * kSide + 5.0 * kGap, kTop + kSide + kBelow, "chart",
                fmt::format("Where techniques look on a sphere of roughness {:g} and eta {:g}", plot.roughness, plot.anisotropy));
    for (int looker = 0; looker < lookers; ++looker)
        draw_sphere(out, plot, looker);
    draw_shares(out, plot, kGap + 3.0 * (kSide + kGap));
    const Shares shares = shares_of(plot, plot.anisotropy);
    out.text(
        kGap, kTop + kSide + 44.0, "note",
        fmt::format("roughness {:g}, eta {:g}, highlight {:g} degrees off the parallels, {} samples; light: looks up, dark: looks down, "
                    "red: against the lobe's mean, bent_normal {:.2f} %, major_axis {:.2f} % of the points",
                    plot.roughness, plot.anisotropy, plot.rotation_deg, plot.samples, 100.0 * shares.of[bent_normal],
                    100.0 * shares.of[major_axis]));
    draw_key(out, kTop + kSide + 74.0, {{"c1", "bent_normal"}, {"c2", "major_axis"}});
    return out;
}

} // namespace burnish
