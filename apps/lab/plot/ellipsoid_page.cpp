#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "apps/lab/plot/ellipsoid.h"
#include "apps/lab/plot/panel.h"
#include "apps/lab/plot/plot.h"
#include "apps/report/axes.h"
#include "apps/report/chart_style.h"
#include "apps/report/html.h"
#include "apps/report/svg.h"
#include "shading/lang/tables.h"

namespace burnish {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

constexpr const char* kStyle =
    R"(body { font: 15px system-ui, "DejaVu Sans", sans-serif; max-width: 1400px; margin: 24px auto; padding: 0 16px;
  color: #1c1c1c; background: #fff; } table { border-collapse: collapse; margin: 12px 0; } th, td { padding: 4px 12px; text-align: right;
  border-bottom: 1px solid #e3e3e3; } th { font-weight: 600; vertical-align: bottom; } svg { max-width: 100%; height: auto; }
p { max-width: 80ch; }
@media (prefers-color-scheme: dark) { body { color: #ececec; background: #161616; } th, td { border-color: #343434; } }
)";

// Text before the tables; braces are doubled for fmt.
constexpr const char* kNormals = R"(<h2>Normals</h2>
<p>D times cosine integrates to 1. The mean normal of a tilted lobe is A<sup>T</sup>A n, not n. Where less of the microsurface is visible than
the surface itself covers (below 1), G1 is clamped; a vertical wall that makes the mean normal n (its area, over the surface's) brings the
least visible area back to 1.</p>
)";
constexpr const char* kSamplers = R"(<h2>Sampling what the eye sees</h2>
<p>{} normals each, by rays into a sphere around the ellipsoid (version 1), by points of its own outline (version 2), both with rejection, and of
the crescent alone, without (version 3, what the program does): the share of points that is kept, the same by projected areas, and the
distance to the density, whose deviation is the root of twice the freedom.</p>
)";
constexpr const char* kEnergy = R"(<h2>A skewed lobe and a normal map of the same peak</h2>
<p>Light that a surface that absorbs nothing gives back, of what reaches it from an angle in the plane of the tilt: alpha 0.25, 25 degrees.
Masking takes from the skewed lobe what it hides; a normal map gives back more than it gets, or nothing.</p>
)";

double degrees_between(const PlotVec& a, const PlotVec& b)
{
    const PlotVec c = cross(a, b);
    return std::atan2(std::sqrt(dot(c, c)), dot(a, b)) * kDegrees;
}

std::string shape_cells(const EllipsoidFigures& f)
{
    const EllipsoidShape& s = f.shape;
    return fmt::format("<td>{:g}, {:g}</td><td>{:g}, {:g}, {:g}</td>", s.alpha_x, s.alpha_y, s.theta_x, s.theta_y, s.theta_z);
}

std::string normal_table(const std::vector<EllipsoidFigures>& all)
{
    std::string rows;
    for (const EllipsoidFigures& f : all)
        rows +=
            fmt::format("<tr>{}<td>{:.7f}</td><td>{:.4f}</td><td>{:.2e}</td><td>{:.2e}</td><td>{:.4f}</td><td>{:.4f}</td><td>{:.4f}</td>"
                        "<td>{:.4f}</td></tr>\n",
                        shape_cells(f), f.projected, degrees_between(f.mean, {0, 0, 1}), degrees_between(f.mean, f.mean_by_shape),
                        f.area_error, 100.0 * f.clamped, f.least_visible, f.wall, f.least_with_wall);
    return "<table id=\"normals\"><tr><th>widths</th><th>angles, rad</th><th>projected area</th><th>mean normal off n, degrees</th>"
           "<th>off A<sup>T</sup>A n, degrees</th><th>visible area off its integral</th><th>directions clamped, %</th>"
           "<th>least visible area</th><th>wall</th><th>least visible area with it</th></tr>\n" +
           rows + "</table>\n";
}

std::string sampler_table(const std::vector<EllipsoidFigures>& all)
{
    std::string rows;
    for (const EllipsoidFigures& f : all) {
        rows += "<tr>" + shape_cells(f);
        for (const SamplerFigures& s : f.samplers)
            rows += fmt::format("<td>{:.4f}</td><td>{:.4f}</td><td>{:.1f} / {}</td>", s.kept, s.kept_by_area, s.chi2, s.freedom);
        rows += "</tr>\n";
    }
    std::string heads;
    for (int version = 1; version <= 3; ++version)
        heads += fmt::format("<th>version {} keeps</th><th>by areas</th><th>chi&sup2; / freedom</th>", version);
    return "<table id=\"samplers\"><tr><th>widths</th><th>angles, rad</th>" + heads + "</tr>\n" + rows + "</table>\n";
}

Drawing draw_energy(const std::vector<EnergyRow>& rows)
{
    constexpr double kWidth = 720.0, kHeight = 320.0, kLeft = 60.0, kFoot = 48.0;
    Drawing out(kWidth, kHeight, "chart", "Light given back by a skewed lobe and by a normal map");
    double most = 1.0;
    for (const EnergyRow& row : rows)
        most = std::max(most, std::min(row.normal_map, 2.5));
    const Axis x = linear_axis(-90.0, 90.0, kLeft, kWidth - 16.0), y = linear_axis(0.0, most, kHeight - kFoot, 16.0);
    for (const double tick : linear_ticks(y, 6)) {
        out.line({{x.from_px, y.at(tick)}, {x.to_px, y.at(tick)}}, "grid");
        out.text(x.from_px - 6.0, y.at(tick) + 4.0, "tick end", number(tick));
    }
    for (const double tick : linear_ticks(x, 8))
        out.text(x.at(tick), kHeight - kFoot + 18.0, "tick middle", number(tick));
    out.open("c0");
    out.line({{x.from_px, y.at(1.0)}, {x.to_px, y.at(1.0)}}, "level");
    out.close();
    const std::pair<double EnergyRow::*, const char*> curves[] = {{&EnergyRow::skew, "c2"}, {&EnergyRow::normal_map, "c1"}};
    for (const auto& [value, family] : curves) {
        Points points;
        for (const EnergyRow& row : rows)
            if (row.*value <= most)
                points.push_back({x.at(row.theta_deg), y.at(row.*value)});
        out.open(family);
        out.line(points, "curve");
        out.close();
    }
    draw_key(out, kHeight - 10.0,
             {{"c2", "skewed lobe"}, {"c1", "normal map of the same peak"}, {"c0", "all light; angle of the light, degrees"}});
    return out;
}

std::string energy_table(const std::vector<EnergyRow>& rows)
{
    std::string text;
    for (const EnergyRow& row : rows)
        text += fmt::format("<tr><td>{:g}</td><td>{:.4f}</td><td>{:.4f}</td></tr>\n", row.theta_deg, row.skew, row.normal_map);
    return "<table id=\"energy\"><tr><th>light, degrees</th><th>skewed lobe</th><th>normal map</th></tr>\n" + text + "</table>\n";
}

Drawing tilted_lobe(double tilt_deg, double eye_deg)
{
    LobePlot plot;
    plot.roughness = 0.5, plot.anisotropy = 0.0, plot.model = lobe_with(kTiltedLobe), plot.tilt_x_deg = tilt_deg;
    plot.theta_deg = eye_deg, plot.phi_deg = 0.0;
    return plot_lobe(plot);
}

} // namespace

std::string ellipsoid_page()
{
    const std::vector<EllipsoidFigures> figures = measure_ellipsoids();
    const std::vector<EnergyRow> energy = measure_skew();
    std::string page =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>The ellipsoid distribution of normals</title>"
        "<style>" +
        std::string(kStyle) + chart_style() + "</style></head><body>\n<h1>The ellipsoid distribution of normals</h1>\n";
    page +=
        fmt::format("<p>Walter, Dong, Marschner and Greenberg 2014 (revised 2016), by the program's kernels in double precision. Integrals "
                    "are sums over {} normals.</p>\n<h2>Lobes, upright and tilted by 25 degrees</h2>\n",
                    kEllipsoidRows * kEllipsoidColumns);
    for (const auto& [tilt, eye] : {std::pair{0.0, 40.0}, std::pair{25.0, 0.0}, std::pair{25.0, 40.0}})
        page += svg_of(tilted_lobe(tilt, eye));
    page += kNormals + normal_table(figures);
    page += fmt::format(kSamplers, kEllipsoidSamples) + sampler_table(figures);
    page += kEnergy + svg_of(draw_energy(energy)) + energy_table(energy);
    return page + "</body></html>\n";
}

} // namespace burnish
